#include "app/restart.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string>

#include "base/error.hpp"
#include "config/scenario_keys.hpp"
#include "process/own_executable.hpp"

namespace pogosim {

namespace {

constexpr auto kVariable = "POGOSIM_RESTART";
constexpr Camera kWholeArena{.centre_mm = {}, .scale_px_mm = 0.0F};  // stands for no camera

// Numbers with blanks between them, then the view as YAML.
std::string text_of(Restart const& restart) {
    std::string text = fmt::format("{} {:d}", restart.seed, restart.overwrite);
    if (restart.window) {
        WindowState const& window = *restart.window;
        ViewOptions const& options = window.options;
        long const selected = options.selected_robot ? static_cast<long>(*options.selected_robot) : -1;
        Camera const camera = window.camera.value_or(kWholeArena);
        text += fmt::format(" {} {} {} {} {:d} {} {} {} {:d} {} {:d} {:d} {}", window.x_px, window.y_px,
                            window.size.width_px, window.size.height_px, window.full_screen, camera.centre_mm.x,
                            camera.centre_mm.y, camera.scale_px_mm, window.paused, window.speed_up, window.panels,
                            window.plot, window.column);
        text += fmt::format(" {}\n{}", selected, view_as_yaml(options));
    }
    return text;
}

std::optional<Restart> restart_of(std::string const& text) {
    std::istringstream numbers(text);
    Restart restart;
    if (!(numbers >> restart.seed >> restart.overwrite)) {
        return std::nullopt;
    }
    WindowState window;
    long selected = -1;
    Camera camera;
    numbers >> window.x_px >> window.y_px >> window.size.width_px >> window.size.height_px >> window.full_screen >>
        camera.centre_mm.x >> camera.centre_mm.y >> camera.scale_px_mm >> window.paused >> window.speed_up >>
        window.panels >> window.plot >> window.column >> selected;
    if (numbers) {
        try {
            window.options = view_from_yaml(std::string(std::istreambuf_iterator<char>(numbers), {}));
        } catch (ConfigError const&) {
            return restart;  // not of a window of ours
        }
        if (selected >= 0) {
            window.options.selected_robot = static_cast<std::uint32_t>(selected);
        }
        if (camera.scale_px_mm > 0.0F) {
            window.camera = camera;
        }
        restart.window = window;
    }
    return restart;
}

}  // namespace

bool is_restarted() {
    return std::getenv(kVariable) != nullptr;
}

std::optional<Restart> take_restart() {
    char const* const value = std::getenv(kVariable);
    if (value == nullptr) {
        return std::nullopt;
    }
    std::string const text = value;
    unsetenv(kVariable);
    return restart_of(text);
}

void restart_program(char** argv, std::filesystem::path const& folder, Restart const& restart) {
    std::error_code ignored;
    std::filesystem::current_path(folder, ignored);  // the program may have left it
    setenv(kVariable, text_of(restart).c_str(), /*overwrite=*/1);
    execv(own_executable().c_str(), argv);
    execvp(argv[0], argv);
    unsetenv(kVariable);
}

}  // namespace pogosim
