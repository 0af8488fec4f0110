#include "view/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

namespace pogosim {

namespace {

constexpr float kAxis = 58.0F / 15.0F;  // left of the plot, for numbers, in the size of the text
constexpr float kGap = 6.0F / 15.0F;
constexpr float kLineWidth = 1.6F / 15.0F;
constexpr ImU32 kBand = IM_COL32(90, 150, 230, 70);
constexpr ImU32 kMean = IM_COL32(110, 170, 245, 255);
constexpr ImU32 kRobot = IM_COL32(255, 190, 80, 255);
constexpr ImU32 kGrid = IM_COL32(255, 255, 255, 28);
constexpr ImU32 kInk = IM_COL32(200, 206, 216, 255);
constexpr int kGridLines = 5;  // at most
constexpr std::array<std::string_view, 4> kBuiltIn{"x", "y", "angle", "pogobot_ticks"};

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(std::span<float const> values) {
        for (float const value : values) {
            if (std::isfinite(value)) {
                low = std::min(low, static_cast<double>(value));
                high = std::max(high, static_cast<double>(value));
            }
        }
    }

    bool is_empty() const { return low > high; }

    /// Never empty, with some room.
    Range widened() const {
        double const width = high - low;
        double const room = width > 0.0 ? 0.05 * width : std::max(0.05 * std::abs(low), 0.5);
        bool const is_never_negative = low >= 0.0;
        return {is_never_negative ? std::max(low - room, 0.0) : low - room, high + room};
    }
};

struct Frame {
    ImVec2 min;
    ImVec2 max;
    Range time_s;
    Range value;

    ImVec2 at(double time, double of_value) const {
        double const x = (time - time_s.low) / (time_s.high - time_s.low);
        double const y = (of_value - value.low) / (value.high - value.low);
        return {min.x + static_cast<float>(x) * (max.x - min.x), max.y - static_cast<float>(y) * (max.y - min.y)};
    }
};

/// Times from one to the next that is drawn: no more points than the plot has columns of pixels.
std::size_t stride_of(Frame const& frame, std::size_t count) {
    auto const columns = static_cast<std::size_t>(std::max(frame.max.x - frame.min.x, 2.0F));
    return (count + columns - 1) / columns;
}

void draw_line(ImDrawList& list, Frame const& frame, std::vector<double> const& times, std::vector<float> const& values,
               ImU32 color) {
    std::size_t const stride = stride_of(frame, times.size());
    for (std::size_t i = stride; i < times.size(); i += stride) {
        std::size_t const before = i - stride;
        if (std::isfinite(values[before]) && std::isfinite(values[i])) {
            list.AddLine(frame.at(times[before], values[before]), frame.at(times[i], values[i]), color,
                         ems(kLineWidth));
        }
    }
}

void draw_band(ImDrawList& list, Frame const& frame, std::vector<double> const& times, ColumnSeries const& swarm) {
    std::size_t const stride = stride_of(frame, times.size());
    for (std::size_t i = stride; i < times.size(); i += stride) {
        std::size_t const before = i - stride;
        if (std::isfinite(swarm.low[before]) && std::isfinite(swarm.low[i])) {
            list.AddQuadFilled(frame.at(times[before], swarm.high[before]), frame.at(times[i], swarm.high[i]),
                               frame.at(times[i], swarm.low[i]), frame.at(times[before], swarm.low[before]), kBand);
        }
    }
}

/// 1, 2 or 5 times a power of ten: the least that divides a range into at most so many parts.
double round_step(Range const& range, int most_parts) {
    double const least = (range.high - range.low) / most_parts;
    double const power = std::pow(10.0, std::floor(std::log10(least)));
    for (double const factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) {
            return factor * power;
        }
    }
    return 10.0 * power;
}

void draw_axes(ImDrawList& list, Frame const& frame) {
    double const step = round_step(frame.value, kGridLines);
    for (double value = std::ceil(frame.value.low / step) * step; value <= frame.value.high; value += step) {
        ImVec2 const left = frame.at(frame.time_s.low, value);
        list.AddLine(left, {frame.max.x, left.y}, kGrid);
        std::string const text = fmt::format("{:.4g}", std::abs(value) < 1e-9 * step ? 0.0 : value);
        float const width = ImGui::CalcTextSize(text.c_str()).x;
        list.AddText({frame.min.x - width - ems(kGap), left.y - 0.5F * ImGui::GetTextLineHeight()}, kInk, text.c_str());
    }
    double const step_s = round_step(frame.time_s, kGridLines);
    for (double time = std::ceil(frame.time_s.low / step_s) * step_s; time <= frame.time_s.high; time += step_s) {
        ImVec2 const bottom = frame.at(time, frame.value.low);
        list.AddLine({bottom.x, frame.min.y}, bottom, kGrid);
        std::string const text = fmt::format("{:.4g} s", time);
        float const left = std::min(bottom.x, frame.max.x - ImGui::CalcTextSize(text.c_str()).x);
        list.AddText({left, frame.max.y + 2.0F}, kInk, text.c_str());
    }
}

/// The first column of the program's own, else the first of all.
std::size_t first_choice(std::vector<std::string> const& columns) {
    auto const own = std::ranges::find_if(
        columns, [](std::string const& name) { return std::ranges::find(kBuiltIn, name) == kBuiltIn.end(); });
    return own == columns.end() ? 0 : static_cast<std::size_t>(own - columns.begin());
}

void choose_column(PanelState& state) {
    std::vector<std::string> const& columns = state.setup->columns;
    if (!state.column_is_chosen) {
        state.column = first_choice(columns);
        state.column_is_chosen = true;
    }
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##column", columns[state.column].c_str())) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (ImGui::Selectable(columns[i].c_str(), i == state.column)) {
                state.column = i;
            }
        }
        ImGui::EndCombo();
    }
    float const room_px =
        ImGui::GetItemRectSize().x - ImGui::GetFrameHeight() - 2.0F * ImGui::GetStyle().FramePadding.x;
    if (ImGui::CalcTextSize(columns[state.column].c_str()).x > room_px) {  // it is cut there
        ImGui::TextWrapped("%s", columns[state.column].c_str());
    }
    ImGui::TextColored(ImColor(kMean), "swarm: mean, 10 to 90 %%");
    if (Inspection const* const one = inspected(state)) {
        ImGui::SameLine();
        ImGui::TextColored(ImColor(kRobot), "robot %d", one->id);
    }
}

void draw_series(PanelState const& state) {
    ColumnHistory const& history = *state.history;
    std::vector<double> const& times = history.times_s();
    ColumnSeries const& swarm = history.swarm(state.column);
    std::vector<float> robot;
    if (Inspection const* const one = inspected(state)) {
        robot = history.robot(state.column, one->robot);
    }
    Range values;
    for (auto const* const series : {&swarm.low, &swarm.mean, &swarm.high, &std::as_const(robot)}) {
        values.add(*series);
    }
    if (times.size() < 2 || values.is_empty()) {
        ImGui::TextDisabled("no values yet (one every save_data_period)");
        return;
    }
    ImVec2 const corner = ImGui::GetCursorScreenPos();
    ImVec2 const room = ImGui::GetContentRegionAvail();
    Frame const frame{.min = {corner.x + ems(kAxis), corner.y + ems(kGap)},
                      .max = {corner.x + room.x, corner.y + room.y - ImGui::GetTextLineHeight() - 2.0F},
                      .time_s = {times.front(), times.back()},
                      .value = values.widened()};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_axes(list, frame);
    draw_band(list, frame, times, swarm);
    draw_line(list, frame, times, swarm.mean, kMean);
    if (!robot.empty()) {
        draw_line(list, frame, times, robot, kRobot);
    }
    if (state.looked_at_s && *state.looked_at_s >= times.front()) {  // the moment that is shown
        double const at_s = std::min(*state.looked_at_s, times.back());
        list.AddLine(frame.at(at_s, frame.value.low), frame.at(at_s, frame.value.high), kInk, 1.0F);
    }
}

}  // namespace

void draw_plot(PanelState& state) {
    if (state.setup->columns.empty()) {
        ImGui::TextDisabled("the run records no data (enable_data_logging: false)");
        return;
    }
    choose_column(state);
    draw_series(state);
}

}  // namespace pogosim
