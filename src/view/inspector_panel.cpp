#include "view/inspector_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

namespace pogosim {

namespace {

constexpr float kWidthPx = 262.0F;
constexpr float kTopPx = 44.0F;  // below the time
constexpr float kMarginPx = 10.0F;
constexpr float kRoomyPx = 700.0F;  // in lower windows, the sections are closed at first: robots are under them
constexpr float kDegreesPerRad = 180.0F / std::numbers::pi_v<float>;
constexpr std::size_t kLongestValue = 500;   // bytes of a text
constexpr std::size_t kMostNeighbours = 40;  // named
constexpr std::array kFaces{"front", "right", "back", "left"};

/// A line of a table of two columns.
void row(char const* name, std::string const& value) {
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", name);
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(value.c_str(), value.c_str() + std::min(value.size(), kLongestValue));
    ImGui::PopTextWrapPos();
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

std::string motor_text(Inspection const& robot, std::size_t motor) {
    return fmt::format("{}, direction {}", robot.motor_power[motor], robot.motor_direction[motor]);
}

void draw_motion(Inspection const& robot) {
    if (robot.has_body) {
        row("position", fmt::format("{:.1f}, {:.1f} mm", robot.position_mm.x, robot.position_mm.y));
        row("heading", fmt::format("{:.3f} rad ({:.0f}\u00b0)", robot.heading_rad, robot.heading_rad * kDegreesPerRad));
        row("speed", fmt::format("{:.1f} mm/s", robot.speed_mm_s));
        row("turning", fmt::format("{:.2f} rad/s", robot.angular_velocity_rad_s));
        row("acceleration",
            fmt::format("{:.2f}, {:.2f} m/s\u00b2", robot.acceleration_m_s2.x, robot.acceleration_m_s2.y));
    }
    row("ticks", fmt::format("{}, at {:.3f} s", robot.ticks, robot.clock_s));
    row("motor left", motor_text(robot, 1));
    row("motor right", motor_text(robot, 0));
    row("motor back", motor_text(robot, 2));
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

void draw_messages(Inspection const& robot) {
    row("sent", std::to_string(robot.messages_sent));
    row("received", std::to_string(robot.messages_received));
    row("in its queue", std::to_string(robot.messages_waiting));
    row("in reach", std::to_string(robot.neighbours.size()));
}

}  // namespace

void draw_inspector(Inspection const& robot, float scale, bool in_its_corner) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - kMarginPx, kTopPx * scale}, in_its_corner ? ImGuiCond_Always : ImGuiCond_Once,
                            {1.0F, 0.0F});
    ImGui::SetNextWindowSizeConstraints({kWidthPx * scale, 0.0F},
                                        {kWidthPx * scale, size.y - kTopPx * scale - kMarginPx});
    ImGui::SetNextWindowSize({kWidthPx * scale, 0.0F});
    std::string const title = fmt::format("Robot {} ({})###inspector", robot.id, robot.category);
    if (ImGui::Begin(title.c_str(), nullptr,
                     ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings)) {
        ImGuiTreeNodeFlags const open = size.y < kRoomyPx * scale ? 0 : ImGuiTreeNodeFlags_DefaultOpen;
        table("motion", [&] { draw_motion(robot); });
        if (ImGui::CollapsingHeader("Messages", open)) {
            table("messages", [&] { draw_messages(robot); });
            if (!robot.neighbours.empty()) {
                ImGui::TextUnformatted(neighbour_text(robot).c_str());
            }
        }
        if (!robot.columns.empty() && ImGui::CollapsingHeader("Data columns", open)) {
            table("columns", [&] {
                for (auto const& [name, value] : robot.columns) {
                    row(name.c_str(), value);
                }
            });
        }
        if (!robot.lines.empty() && ImGui::CollapsingHeader("Printed", open)) {
            ImGui::PushTextWrapPos(0.0F);
            for (std::string const& line : robot.lines) {
                ImGui::TextUnformatted(line.c_str());
            }
            ImGui::PopTextWrapPos();
        }
        if (ImGui::CollapsingHeader("LEDs and sensors")) {
            table("leds", [&] {
                draw_leds(robot);
                row("light", fmt::format("{} back, {} left, {} right", robot.light[0], robot.light[1], robot.light[2]));
            });
        }
    }
    ImGui::End();
}

}  // namespace pogosim
