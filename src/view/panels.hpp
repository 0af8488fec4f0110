// The panels over the picture, drawn with Dear ImGui: control, inspector, plot, help.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/inspection.hpp"
#include "view/column_history.hpp"
#include "view/messages.hpp"
#include "view/mouse_states.hpp"
#include "view/panel_layout.hpp"
#include "view/panel_raster.hpp"

namespace pogosim {

/// The panel says so when a step takes longer than this.
inline constexpr double kBusyS = 0.5;

/// Input for the panels.
struct PanelInput {
    MouseState mouse;
    float wheel = 0.0F;                // lines up
    float seconds = 0.0F;              // since the last picture
    std::string text{};                // typed since then, UTF-8
    std::vector<std::int32_t> keys{};  // pressed since then, SDL's SDL_Keycode
    bool ctrl = false;
    bool shift = false;
};

/// A restart would overwrite files: what becomes of them?
struct RestartQuestion {
    std::uint32_t seed = 0;          // that the new run is to have
    std::vector<std::string> files;  // see RestartCheck::overwritten
};
enum class RestartAnswer { keep, overwrite, cancel };

/// The user's wishes.
struct PanelActions {
    std::function<void(Command const&)> send;
    std::function<void()> save_picture;
    std::function<void(RestartAnswer)> answer;
    std::function<void(double time_s)> look_at;  // the moment of that time
    std::function<void()> look_at_newest;
};

/// The state that the panels show and change.
struct PanelState {
    WindowSetup const* setup = nullptr;
    Moment const* moment = nullptr;     // null: none yet
    RunStatus const* status = nullptr;  // see RunRequests
    ColumnHistory const* history = nullptr;
    ViewOptions* options = nullptr;
    bool help = false;
    bool control = true;
    bool plot = false;
    std::size_t column = 0;             // in the plot
    bool column_is_chosen = false;      // else the first of the user's own is shown
    double seconds_since_moment = 0.0;  // the run has shown nothing new for so long
    std::string message;                // shown for a while in the middle
    std::optional<RestartQuestion> question{};
    std::optional<double> looked_at_s{};  // the time of a moment that is past; absent: the newest is shown
    double newest_s = 0.0;
    std::string condition{};  // to pause by, as it is being typed
};

/// The selected robot at the moment that is shown; null: there is none, or another one was selected then.
Inspection const* inspected(PanelState const& state);

class Panels {
public:
    /// `scale`: of the text, 1 for 96 dots per inch.
    explicit Panels(float scale);
    ~Panels();
    Panels(Panels const&) = delete;
    Panels& operator=(Panels const&) = delete;

    /// Lays the panels out and draws them.
    void draw(Canvas& canvas, PanelInput const& input, PanelState& state, PanelActions const& actions);

    /// True when the mouse is over a panel, or holds a part of one: it is not for the picture then.
    bool has_mouse() const;

    /// True while the user types into a field: keys are letters then.
    bool wants_text() const;

private:
    PanelRoom room_now(PanelState const& state) const;
    void draw_all(PanelState& state, PanelActions const& actions);

    struct DestroyContext {
        void operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }
    };
    std::unique_ptr<ImGuiContext, DestroyContext> context_;
    GlyphAtlas atlas_;
    float scale_;
    PanelLayout layout_{};           // in which the panels were put last
    float control_px_ = 0.0F;        // height of the control panel when it was last open; 0: not known yet
    float control_least_px_ = 0.0F;  // the same while its section "View" was closed
    // Which are not collapsed, by the layout or the user.
    bool control_is_open_ = true;
    bool inspector_is_open_ = true;
    bool plot_is_open_ = true;
};

/// A length in the size of the text, pixels, so that it grows with the text.
inline float ems(float count) {
    return count * ImGui::GetFontSize();
}

// What fills panels that are open: inspector_panel.cpp, plot_panel.cpp.

/// About the selected robot.
void draw_inspector(Inspection const& robot);

/// A data column over time: the selected robot, the mean of the swarm, and its 10th to 90th percentile.
void draw_plot(PanelState& state);

}  // namespace pogosim
