#include "view/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/text.hpp"
#include "view/actions.hpp"
#include "view/inspector_panel.hpp"
#include "view/plot_panel.hpp"

namespace pogosim {

namespace {

constexpr float kTextPx = 15.0F;
constexpr float kMarginPx = 10.0F;
constexpr float kControlWidthPx = 236.0F;
constexpr float kLeastWidthPx = 320.0F;  // of a picture with panels
constexpr float kLeastHeightPx = 240.0F;
ImVec4 const kWarning{1.0F, 0.66F, 0.25F, 1.0F};
constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings;

void set_style(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.AntiAliasedLinesUseTex = false;  // the raster draws triangles, not textures
    style.WindowRounding = 5.0F;
    style.FrameRounding = 3.0F;
    style.GrabRounding = 3.0F;
    style.WindowBorderSize = 0.0F;
    style.WindowPadding = {10.0F, 8.0F};
    style.ItemSpacing = {7.0F, 5.0F};
    style.Colors[ImGuiCol_WindowBg] = {0.09F, 0.10F, 0.13F, 0.88F};
    style.Colors[ImGuiCol_TitleBg] = {0.07F, 0.08F, 0.10F, 0.92F};
    style.Colors[ImGuiCol_TitleBgActive] = {0.12F, 0.15F, 0.20F, 0.95F};
    style.Colors[ImGuiCol_TitleBgCollapsed] = {0.07F, 0.08F, 0.10F, 0.80F};
    style.Colors[ImGuiCol_PlotHistogram] = {0.31F, 0.55F, 0.85F, 1.0F};
    style.ScaleAllSizes(scale);
}

std::string speed_text(double speed_up) {
    return speed_up >= 100.0 ? fmt::format("{:.0f} x", speed_up) : fmt::format("{:.3g} x", speed_up);
}

void draw_speed(PanelState const& state, std::function<void(Command const&)> const& send) {
    RunStatus const& status = state.status;
    constexpr float kSlowest = 0.05F;
    constexpr float kFastest = 1000.0F;
    bool unlimited = status.asked_speed_up == 0.0;
    auto asked = static_cast<float>(status.asked_speed_up);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("speed");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-66.0F);
    char const* const format = unlimited ? "no limit" : "%.3g x";
    float shown = unlimited ? kFastest : asked;
    if (ImGui::SliderFloat("##speed", &shown, kSlowest, kFastest, format,
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoInput)) {
        send(SetSpeedUp{static_cast<double>(shown)});
    }
    ImGui::SameLine();
    if (ImGui::Checkbox("max", &unlimited)) {
        send(SetSpeedUp{unlimited ? 0.0 : 1.0});
    }
    if (state.seconds_since_moment > kBusyS) {
        ImGui::TextColored(kWarning, "busy with one step for %.0f s", state.seconds_since_moment);
    } else if (status.paused) {
        ImGui::TextUnformatted("paused");
    } else if (status.too_slow) {
        ImGui::TextColored(kWarning, "%s",
                           fmt::format("the machine reaches only {}", speed_text(status.speed_up)).c_str());
    } else if (status.speed_up > 0.0) {
        ImGui::TextUnformatted(fmt::format("running at {} real time", speed_text(status.speed_up)).c_str());
    } else {
        ImGui::TextUnformatted("running");
    }
}

void draw_switches(PanelState& state) {
    PaintOptions& options = *state.options;
    if (!ImGui::CollapsingHeader("View")) {
        return;
    }
    ImGui::Checkbox("trails", &options.trails);
    int layer = static_cast<int>(options.links);
    ImGui::SetNextItemWidth(90.0F);
    if (ImGui::Combo("channels", &layer, "off\0below\0above\0")) {
        options.links = static_cast<LinkLayer>(layer);
    }
    ImGui::Checkbox("lateral LEDs", &options.lateral_leds);
    ImGui::Checkbox("light levels", &options.light_levels);
    bool overlays = options.time || options.scale_bar;
    if (ImGui::Checkbox("time and scale bar", &overlays)) {
        options.time = options.scale_bar = overlays;
    }
    ImGui::Checkbox("plot of a data column", &state.plot);
}

void draw_control(PanelState& state, float scale, std::function<void(Command const&)> const& send) {
    WindowSetup const& setup = *state.setup;
    ImGui::SetNextWindowPos({kMarginPx, kMarginPx}, ImGuiCond_Once);
    ImGui::SetNextWindowSize({kControlWidthPx * scale, 0.0F});
    if (ImGui::Begin("Run", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize) && state.moment != nullptr) {
        RunStatus const& status = state.status;
        if (ImGui::Button(status.paused ? "Run" : "Pause", {66.0F * scale, 0.0F})) {
            send(Pause{!status.paused});
        }
        ImGui::SameLine();
        if (ImGui::Button("Step")) {
            send(StepOnce{});
        }
        ImGui::SameLine();
        if (ImGui::Button("Restart")) {
            send(Restart{setup.seed});
        }
        double const time_s = state.moment->snapshot.time_s;
        double const share = setup.duration_s > 0.0 ? time_s / setup.duration_s : 1.0;
        ImGui::ProgressBar(static_cast<float>(share), {-1.0F, 0.0F},
                           fmt::format("{:.2f} of {:g} s", time_s, setup.duration_s).c_str());
        draw_speed(state, send);
        ImGui::TextUnformatted(fmt::format("seed {}{}", setup.seed, status.touched ? ", touched" : "").c_str());
        ImGui::SameLine(0.62F * ImGui::GetWindowWidth());
        ImGui::TextDisabled("F1: help");
        draw_switches(state);
    }
    ImGui::End();
}

void draw_help(PanelState& state) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowFocus();
    if (ImGui::Begin("Keys and mouse", &state.help,
                     kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse) &&
        ImGui::BeginTable("help", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (Help const& line : help_lines()) {
            ImGui::TableNextColumn();
            ImGui::TextColored(kWarning, "%s", line.input);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.effect);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void draw_message(std::string const& text) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * size.x, size.y - kMarginPx}, ImGuiCond_Always, {0.5F, 1.0F});
    ImGui::Begin("##message", nullptr,
                 kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushTextWrapPos(std::max(size.x - 6.0F * kMarginPx, kMarginPx));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace

Panels::Panels(float scale) : context_(ImGui::CreateContext()), scale_(scale) {
    ImGui::SetCurrentContext(context_.get());
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // long texts and plots have many corners
    set_style(scale);
    std::string const font(system_font());
    if (font.empty() || io.Fonts->AddFontFromFileTTF(font.c_str(), kTextPx * scale) == nullptr) {
        io.Fonts->AddFontDefault();
    }
    atlas_ = make_glyph_atlas(*io.Fonts);
}

Panels::~Panels() = default;

bool Panels::has_mouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}

void Panels::draw(Canvas& canvas, PanelInput const& input, PanelState& state,
                  std::function<void(Command const&)> const& send) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(canvas.size().width_px), static_cast<float>(canvas.size().height_px)};
    io.DeltaTime = std::max(input.seconds, 1e-4F);
    io.MousePos = {input.mouse.point_px.x, input.mouse.point_px.y};
    io.MouseDown[0] = input.mouse.left_is_down;
    io.MouseWheel = input.wheel;
    ImGui::NewFrame();
    bool const has_room = io.DisplaySize.x >= kLeastWidthPx && io.DisplaySize.y >= kLeastHeightPx;
    if (state.control && has_room) {
        draw_control(state, scale_, send);
        if (state.moment != nullptr && state.moment->inspection) {
            bool const was_resized = inspector_size_ != canvas.size();
            inspector_size_ = canvas.size();
            draw_inspector(*state.moment->inspection, scale_, was_resized);
        }
        if (state.plot) {
            draw_plot(state, scale_);
        }
    }
    if (state.help) {
        draw_help(state);
    }
    if (!state.message.empty()) {
        draw_message(state.message);
    }
    ImGui::Render();
    draw_panels(canvas, *ImGui::GetDrawData(), atlas_);
}

}  // namespace pogosim
