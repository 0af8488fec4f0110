// The panels over the picture, drawn with Dear ImGui: control, inspector, plot, help.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/column_history.hpp"
#include "view/messages.hpp"
#include "view/mouse_states.hpp"
#include "view/panel_raster.hpp"

namespace pogosim {

/// A step that takes longer is worth a word.
inline constexpr double kBusyS = 0.5;

/// What the panels see of the user.
struct PanelInput {
    MouseState mouse;
    float wheel = 0.0F;    // lines up
    float seconds = 0.0F;  // since the last picture
};

/// What the panels show and change.
struct PanelState {
    WindowSetup const* setup = nullptr;
    Moment const* moment = nullptr;  // null: none yet
    RunStatus status;                // of the run, or what the user has asked of it since
    ColumnHistory const* history = nullptr;
    PaintOptions* options = nullptr;
    bool help = false;
    bool control = true;
    bool plot = false;
    std::size_t column = 0;             // in the plot
    bool column_is_chosen = false;      // else the first of the user's own is shown
    double seconds_since_moment = 0.0;  // the run has shown nothing new for so long
    std::string message;                // shown for a while in the middle
};

class Panels {
public:
    /// `scale`: of the text, 1 for 96 dots per inch.
    explicit Panels(float scale);
    ~Panels();
    Panels(Panels const&) = delete;
    Panels& operator=(Panels const&) = delete;

    /// Lays the panels out and draws them. `send` takes what the user asks for.
    void draw(Canvas& canvas, PanelInput const& input, PanelState& state,
              std::function<void(Command const&)> const& send);

    /// True when the mouse is over a panel, or holds a part of one: it is not for the picture then.
    bool has_mouse() const;

private:
    struct DestroyContext {
        void operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }
    };
    std::unique_ptr<ImGuiContext, DestroyContext> context_;
    GlyphAtlas atlas_;
    float scale_;
    PictureSize inspector_size_{0, 0};  // of the window in which the inspector was last shown
};

}  // namespace pogosim
