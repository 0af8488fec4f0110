#include "view/sdl_window.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace pogosim {

namespace {

constexpr int kLeastSizePx = 16;
constexpr float kPlainDotsPerInch = 96.0F;
constexpr float kMostScale = 3.0F;

/// If no display can be reached, SDL falls back to a driver that draws nowhere, or to a console.
void check_driver() {
    char const* const driver = SDL_GetCurrentVideoDriver();
    if (driver == nullptr || SDL_getenv("SDL_VIDEODRIVER") != nullptr) {
        return;
    }
    std::string const name = driver;
    if (name == "offscreen" || name == "dummy" || name == "evdev" || name == "KMSDRM" || name == "directfb") {
        SDL_QuitSubSystem(SDL_INIT_VIDEO);
        throw std::runtime_error("the display that DISPLAY or WAYLAND_DISPLAY names cannot be reached");
    }
}

[[noreturn]] void fail() {
    std::string const reason = SDL_GetError();
    throw std::runtime_error(reason.empty() ? "SDL gives no reason" : reason);
}

}  // namespace

SdlWindow::SdlWindow(WindowSetup const& setup) {
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // Ctrl-C is the simulator's
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    SDL_SetHint(SDL_HINT_APP_NAME, "Pogosim");
    SDL_SetMainReady();
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) {
        fail();
    }
    check_driver();
    // Without a graphics card, drawing through OpenGL takes several times as long as shared memory.
    if (char const* const driver = SDL_GetCurrentVideoDriver(); driver != nullptr && std::string(driver) == "x11") {
        SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    }
    bool const restored = setup.restored.has_value();
    int const x = restored ? setup.restored->x_px : static_cast<int>(SDL_WINDOWPOS_UNDEFINED);
    int const y = restored ? setup.restored->y_px : static_cast<int>(SDL_WINDOWPOS_UNDEFINED);
    auto const [width, height] = restored ? setup.restored->size : setup.size;
    window_.reset(
        SDL_CreateWindow(setup.title.c_str(), x, y, width, height, SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI));
    if (!window_ || SDL_GetWindowSurface(window_.get()) == nullptr) {
        std::string const reason = SDL_GetError();
        window_.reset();
        SDL_QuitSubSystem(SDL_INIT_VIDEO);
        SDL_SetError("%s", reason.c_str());
        fail();
    }
    SDL_SetWindowMinimumSize(window_.get(), kLeastSizePx, kLeastSizePx);
    SDL_StopTextInput();  // keys are commands
    if (restored && setup.restored->full_screen) {
        toggle_full_screen();
    }
}

// SDL stays: when it leaves the X server it hands errors back to Xlib, which ends the program for the least of them.
SdlWindow::~SdlWindow() = default;

PictureSize SdlWindow::size_on_desktop() const {
    PictureSize size;
    SDL_GetWindowSize(window_.get(), &size.width_px, &size.height_px);
    return {std::max(size.width_px, 1), std::max(size.height_px, 1)};
}

PictureSize SdlWindow::size() const {
    SDL_Surface const* const surface = SDL_GetWindowSurface(window_.get());
    return surface != nullptr ? PictureSize{std::max(surface->w, 1), std::max(surface->h, 1)} : size_on_desktop();
}

Vec2 SdlWindow::to_pixels(int x, int y) const {
    PictureSize const pixels = size();
    PictureSize const desktop = size_on_desktop();
    return {static_cast<float>(x) * static_cast<float>(pixels.width_px) / static_cast<float>(desktop.width_px),
            static_cast<float>(y) * static_cast<float>(pixels.height_px) / static_cast<float>(desktop.height_px)};
}

bool SdlWindow::is_visible() const {
    return (SDL_GetWindowFlags(window_.get()) & (SDL_WINDOW_MINIMIZED | SDL_WINDOW_HIDDEN)) == 0;
}

void SdlWindow::show(Canvas const& canvas) {
    SDL_Surface* const surface = SDL_GetWindowSurface(window_.get());
    if (surface == nullptr) {
        return;  // it is being resized; the next picture comes soon
    }
    int const width = std::min(surface->w, canvas.size().width_px);
    int const height = std::min(surface->h, canvas.size().height_px);
    int const bytes_per_row = canvas.size().width_px * static_cast<int>(sizeof(Pixel));
    SDL_LockSurface(surface);
    SDL_ConvertPixels(width, height, SDL_PIXELFORMAT_ARGB8888, canvas.pixels().data(), bytes_per_row,
                      surface->format->format, surface->pixels, surface->pitch);
    SDL_UnlockSurface(surface);
    SDL_UpdateWindowSurface(window_.get());
}

void SdlWindow::take_text(bool on) {
    if (on != (SDL_IsTextInputActive() == SDL_TRUE)) {
        on ? SDL_StartTextInput() : SDL_StopTextInput();
    }
}

void SdlWindow::toggle_full_screen() {
    write_place(windowed_);
    full_screen_ = !full_screen_;
    SDL_SetWindowFullscreen(window_.get(), full_screen_ ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
}

void SdlWindow::write_place(WindowState& state) const {
    state.full_screen = full_screen_;
    if (full_screen_) {
        state.x_px = windowed_.x_px;
        state.y_px = windowed_.y_px;
        state.size = windowed_.size;
        return;
    }
    SDL_GetWindowPosition(window_.get(), &state.x_px, &state.y_px);
    state.size = size_on_desktop();
}

float SdlWindow::text_scale() const {
    if (float const scale = to_pixels(1, 1).x; scale > 1.0F) {
        return std::min(scale, kMostScale);
    }
    if (char const* const scale = SDL_getenv("GDK_SCALE"); scale != nullptr && SDL_atoi(scale) > 0) {
        return std::min(static_cast<float>(SDL_atoi(scale)), kMostScale);
    }
    float dots_per_inch = kPlainDotsPerInch;
    int const display = SDL_GetWindowDisplayIndex(window_.get());
    if (display < 0 || SDL_GetDisplayDPI(display, nullptr, &dots_per_inch, nullptr) != 0) {
        return 1.0F;
    }
    return std::clamp(std::round(2.0F * dots_per_inch / kPlainDotsPerInch) / 2.0F, 1.0F, kMostScale);
}

namespace {

// Xlib's, without its headers.
struct Display;
struct XErrorEvent {
    int type;
    Display* display;
    unsigned long resource_id;
    unsigned long serial;
    unsigned char error_code;
    unsigned char request_code;
    unsigned char minor_code;
};
using LostHandler = int (*)(Display*);
using ErrorHandler = int (*)(Display*, XErrorEvent*);
constexpr unsigned char kBadRequest = 1;
constexpr unsigned char kBadAccess = 10;
constexpr unsigned char kFirstExtension = 128;
constexpr unsigned char kShmAttach = 1;

sigjmp_buf* jump_point = nullptr;
ErrorHandler (*set_error_handler)(ErrorHandler) = nullptr;

int on_lost_connection(Display* /*display*/) {
    siglongjmp(*jump_point, 1);
}

/// A server on another machine (ssh -X, ssh -Y, TCP) has the extension for shared memory, and answers BadRequest to its
/// use. SDL sends pictures over the connection instead only after BadAccess; otherwise the window would stay black.
bool refuses_shared_memory(XErrorEvent const& error) {
    return error.error_code == kBadRequest && error.request_code >= kFirstExtension && error.minor_code == kShmAttach;
}

/// Xlib's own one ends the program. An error of one request, such as for a window that is just closing, does no harm.
int on_error(Display* display, XErrorEvent* error) {
    if (!refuses_shared_memory(*error)) {
        return 0;
    }
    error->error_code = kBadAccess;  // SDL's own handler has passed it on to this one, and keeps this one
    ErrorHandler const sdl_handler = set_error_handler(on_error);
    set_error_handler(sdl_handler);
    return sdl_handler == on_error ? 0 : sdl_handler(display, error);
}

}  // namespace

void jump_when_display_is_lost(sigjmp_buf& point) {
    // SDL loads the library; linking it would make every window need X.
    void* const xlib = dlopen("libX11.so.6", RTLD_NOW);
    if (xlib == nullptr) {
        return;
    }
    jump_point = &point;
    using SetLostHandler = LostHandler (*)(LostHandler);
    if (auto const set = reinterpret_cast<SetLostHandler>(dlsym(xlib, "XSetIOErrorHandler"))) {
        set(on_lost_connection);
    }
    set_error_handler = reinterpret_cast<decltype(set_error_handler)>(dlsym(xlib, "XSetErrorHandler"));
    if (set_error_handler != nullptr) {
        set_error_handler(on_error);
    }
}

}  // namespace pogosim
