#include "sim/window_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "base/background_thread.hpp"
#include "base/library_folder.hpp"
#include "view/module.hpp"

namespace pogosim {

namespace {

constexpr std::chrono::seconds kLongestOpening{20};
constexpr std::chrono::seconds kLongestClosing{2};

std::atomic<bool> left_behind = false;

/// SDL's own message hardly explains a missing display.
void check_display() {
    if (!has_display()) {
        throw std::runtime_error("there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)");
    }
}

ShowWindow load_module() {
    std::string const path = (library_folder() / kModuleFile).string();  // where it is built, and where it is installed
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        throw std::runtime_error(fmt::format("the module of the window cannot be loaded: {}", dlerror()));
    }
    auto const show = reinterpret_cast<ShowWindow>(dlsym(module, kShowWindowName));
    if (show == nullptr) {
        throw std::runtime_error(fmt::format("{} is no module of Pogosim", path));
    }
    return show;
}

}  // namespace

bool has_display() {
#if defined(__APPLE__)
    return true;
#else
    auto const is_set = [](char const* name) {
        char const* const value = std::getenv(name);
        return value != nullptr && *value != '\0';
    };
    return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") || is_set("SDL_VIDEODRIVER");
#endif
}

OpenWindow::OpenWindow(WindowSetup const& setup) : exchange_(std::make_shared<Exchange>()) {
    check_display();
    ShowWindow const show = load_module();
    // The thread may outlive this object.
    thread_ =
        start_background_thread("drawing the window", [show, setup, exchange = exchange_] { show(setup, *exchange); });
    auto const error = exchange_->wait_until_opened(kLongestOpening);
    if (error && error->empty()) {
        return;
    }
    if (error) {
        thread_.join();
        left_behind = exchange_->end() == WindowEnd::display_lost;
        throw std::runtime_error(*error);
    }
    exchange_->close();
    thread_.detach();
    left_behind = true;
    throw std::runtime_error("the display does not answer");
}

OpenWindow::~OpenWindow() {
    exchange_->close();
    if (exchange_->wait_until_ended(kLongestClosing)) {
        thread_.join();
        // Xlib and SDL were left in the middle of something: what they do at the exit would wait for it.
        left_behind = left_behind || exchange_->end() == WindowEnd::display_lost;
    } else {
        thread_.detach();
        left_behind = true;
    }
}

bool window_was_left_behind() {
    return left_behind;
}

}  // namespace pogosim
