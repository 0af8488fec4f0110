// A window whose pixels are drawn by us. The only place, besides input, that uses SDL.
#pragma once

#include <SDL.h>

#include <csetjmp>
#include <memory>
#include <optional>
#include <string>

#include "render/canvas.hpp"
#include "view/messages.hpp"

namespace pogosim {

class SdlWindow {
public:
    /// Throws std::runtime_error, with SDL's reason.
    explicit SdlWindow(WindowSetup const& setup);
    ~SdlWindow();
    SdlWindow(SdlWindow const&) = delete;
    SdlWindow& operator=(SdlWindow const&) = delete;

    /// In pixels of the screen, of which a scaled display has several for each of SDL's.
    PictureSize size() const;

    /// The pixel at a place of SDL's, such as that of a mouse.
    Vec2 to_pixels(int x, int y) const;

    bool is_visible() const;

    /// Copies the canvas into the window. Sizes may differ while the window is being resized.
    void show(Canvas const& canvas);

    void toggle_full_screen();

    /// Whether keys are letters of a text, or commands.
    void take_text(bool on);

    /// Writes where it is on the screen, for the next run.
    void write_place(WindowState& state) const;

    /// Pixels of text for each pixel at 96 dots per inch, 1 to 3: by the scale of the desktop (Wayland, macOS; on X11
    /// GDK_SCALE), else by the dots per inch of the display.
    float text_scale() const;

private:
    /// In SDL's units, in which windows are placed.
    PictureSize size_on_desktop() const;

    struct DestroyWindow {
        void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
    };
    std::unique_ptr<SDL_Window, DestroyWindow> window_;
    bool full_screen_ = false;
    WindowState windowed_;  // its place before it was full screen
};

// Handles a display that is lost while a window is open. Xlib would end the program; the run must go on.

/// From now on a lost connection to the X server jumps to `point`, in the thread that talks to the server. Nothing of
/// SDL may be called afterwards. Call it before SDL connects to the server. Does nothing without X.
void jump_when_display_is_lost(sigjmp_buf& point);

}  // namespace pogosim
