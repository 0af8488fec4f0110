#include "view/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

namespace pogosim {

namespace {

constexpr float kDegreesPerRad = 180.0F / std::numbers::pi_v<float>;
constexpr std::size_t kLongestValue = 500;   // bytes of a text
constexpr std::size_t kMostNeighbours = 40;  // named
constexpr std::array kFaces{"front", "right", "back", "left"};

/// On several lines where it is long.
void wrapped(std::string const& text) {
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(text.c_str(), text.c_str() + std::min(text.size(), kLongestValue));
    ImGui::PopTextWrapPos();
}

/// Breaks a name of a program's variable behind '_' and '.', where it is too long for one line.
std::string in_lines(std::string const& name, float width_px) {
    std::string text;
    std::size_t line = 0;  // where it begins in the text
    for (std::size_t begin = 0; begin < name.size();) {
        std::size_t const end = std::min(name.size() - 1, name.find_first_of("_.", begin)) + 1;
        std::string const part = name.substr(begin, end - begin);
        if (text.size() > line && ImGui::CalcTextSize((text.substr(line) + part).c_str()).x > width_px) {
            text += '\n';
            line = text.size();
        }
        text += part;
        begin = end;
    }
    return text;
}

/// A line of a table of two columns.
void row(std::string const& name, std::string const& value) {
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    wrapped(name.find(' ') == std::string::npos ? in_lines(name, ImGui::GetContentRegionAvail().x) : name);
    ImGui::PopStyleColor();
    ImGui::TableNextColumn();
    wrapped(value);
}

/// Draws lines of `draw`, which calls row().
template <class Draw>
void table(char const* name, Draw const& draw) {
    if (ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingStretchProp)) {
        ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 0.4F);
        ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.6F);
        draw();
        ImGui::EndTable();
    }
}

/// `forward`: the direction bit that drives the robot forward.
std::string wheel_text(Inspection const& robot, std::size_t motor, int forward) {
    int const direction = robot.motor_direction[motor];
    return fmt::format("{} {} (direction {})", robot.motor_power[motor], direction == forward ? "forward" : "backward",
                       direction);
}

std::string joined(std::vector<std::string> const& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < kMostNeighbours; ++i) {
        text += (i > 0 ? ", " : "") + names[i];
    }
    return text.empty() ? "nothing" : text;
}

/// Without the sign of what is rounded to zero.
std::string decimals(float value, int count) {
    std::string const text = fmt::format("{:.{}f}", value, count);
    bool const is_zero = text.find_first_of("123456789") == std::string::npos;
    return text.starts_with('-') && is_zero ? text.substr(1) : text;
}

/// "-0.02 to 0.15 N", or "0.15 N" of one link.
std::string tension_text(Inspection const& robot) {
    std::string const most = decimals(robot.most_tension_n, 3) + " N";
    return robot.links == 1 ? most : fmt::format("{} to {}", decimals(robot.least_tension_n, 3), most);
}

void draw_motion(Inspection const& robot) {
    row("category", robot.category);
    if (robot.has_body) {
        row("position", fmt::format("{:.1f}, {:.1f} mm", robot.position_mm.x, robot.position_mm.y));
        row("heading", fmt::format("{} rad ({}\u00b0)", decimals(robot.heading_rad, 3),
                                   decimals(robot.heading_rad * kDegreesPerRad, 0)));
        row(fmt::format("speed, mean of {:g} s", Inspection::kSpeedWindowS),
            fmt::format("{:.1f} mm/s", robot.speed_mm_s));
        row(robot.moved_during_s < 0.9995 ? fmt::format("moved in the last {:.2f} s", robot.moved_during_s)
                                          : "moved in the last second",
            fmt::format("{:.1f} mm", robot.moved_mm));
        row("touches", joined(robot.touches));
        if (robot.links > 0) {
            row("links", fmt::format("{}, tension {}", robot.links, tension_text(robot)));
        }
        row("turning", decimals(robot.angular_velocity_rad_s, 2) + " rad/s");
        row("acceleration", fmt::format("{}, {} m/s\u00b2", decimals(robot.acceleration_m_s2.x, 2),
                                        decimals(robot.acceleration_m_s2.y, 2)));
    }
    row("ticks", fmt::format("{}, at {:.3f} s", robot.ticks, robot.clock_s));
    row("motor left", wheel_text(robot, 1, 1));
    row("motor right", wheel_text(robot, 0, 0));
    row("motor back", fmt::format("{} (direction {})", robot.motor_power[2], robot.motor_direction[2]));
}

/// "12 back, 13 left, 14 right", as Pogolib names the sensors.
std::string light_text(std::vector<int> const& levels) {
    static constexpr std::array kSides{"back", "left", "right"};
    std::string text;
    for (std::size_t sensor = 0; sensor < levels.size(); ++sensor) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", levels[sensor], kSides[sensor]);
    }
    return text.empty() ? "no sensors" : text;
}

/// The magnetometer is shown once the program has read it.
void draw_sensors(Inspection const& robot) {
    row("light", light_text(robot.light));
    if (robot.magnetometer_samples > 0) {
        row("magnetometer",
            fmt::format("{}, {}, {}, read {} time{}", robot.magnetometer[0], robot.magnetometer[1],
                        robot.magnetometer[2], robot.magnetometer_samples, robot.magnetometer_samples == 1 ? "" : "s"));
    }
}

void draw_leds(Inspection const& robot) {
    static constexpr std::array kNames{"head", "front", "right", "back", "left"};
    for (std::size_t i = 0; i < robot.led.size(); ++i) {
        Rgb const led = robot.led[i];
        row(kNames[i], fmt::format("{}, {}, {}", led.r, led.g, led.b));
    }
}

std::string neighbour_text(Inspection const& robot) {
    std::string text;
    for (std::size_t i = 0; i < robot.neighbours.size() && i < kMostNeighbours; ++i) {
        Neighbour const& other = robot.neighbours[i];
        std::string faces;
        for (std::size_t face = 0; face < kFaces.size(); ++face) {
            if ((other.emitters >> face & 1U) != 0) {
                faces += fmt::format("{}{}", faces.empty() ? "" : ", ", kFaces[face]);
            }
        }
        text += fmt::format("{}{} at {:.0f} mm ({})", text.empty() ? "" : "\n", other.id, other.distance_mm, faces);
    }
    return text;
}

void draw_pairs(std::vector<std::pair<std::string, std::string>> const& pairs) {
    for (auto const& [name, value] : pairs) {
        row(name, value);
    }
}

void draw_variables(Inspection const& robot) {
    if (!robot.variables.empty()) {
        table("variables", [&] { draw_pairs(robot.variables); });
    } else {
        wrapped(robot.no_variables.empty() ? "robots have none of their own (USERDATA)" : robot.no_variables);
    }
}

void draw_messages(Inspection const& robot) {
    row("sent", std::to_string(robot.messages_sent) + (robot.is_muted ? ", muted" : ""));
    row("received", std::to_string(robot.messages_received));
    row("in its queue", std::to_string(robot.messages_waiting));
    row("in reach", std::to_string(robot.neighbours.size()));
}

}  // namespace

void draw_inspector(Inspection const& robot) {
    table("motion", [&] { draw_motion(robot); });
    if (ImGui::CollapsingHeader("Variables", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_variables(robot);
    }
    if (ImGui::CollapsingHeader("Messages", ImGuiTreeNodeFlags_DefaultOpen)) {
        table("messages", [&] { draw_messages(robot); });
        if (!robot.neighbours.empty()) {
            wrapped(neighbour_text(robot));
        }
    }
    std::string const columns = fmt::format("Data columns at t = {:g} s###columns", robot.columns_time_s);
    if (!robot.columns.empty() && ImGui::CollapsingHeader(columns.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
        table("columns", [&] { draw_pairs(robot.columns); });
    }
    if (!robot.lines.empty() && ImGui::CollapsingHeader("Printed", ImGuiTreeNodeFlags_DefaultOpen)) {
        for (std::string const& line : robot.lines) {
            wrapped(line);
        }
    }
    if (ImGui::CollapsingHeader("LEDs and sensors")) {
        table("leds", [&] {
            draw_leds(robot);
            draw_sensors(robot);
        });
    }
}

}  // namespace pogosim
