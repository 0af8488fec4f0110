#include "view/screenshot.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>

#include "render/png_file.hpp"

namespace pogosim {

namespace {

constexpr int kMostScreenshots = 10000;

}  // namespace

std::string save_screenshot(Canvas const& canvas) {
    namespace fs = std::filesystem;
    std::error_code error;
    for (int i = 1; i < kMostScreenshots; ++i) {
        std::string const name = fmt::format("screenshot-{:03}.png", i);
        if (fs::exists(name, error)) {
            continue;
        }
        try {
            write_png(name, canvas);
            return fmt::format("saved {}", fs::absolute(name, error).string());
        } catch (std::exception const& problem) {
            return fmt::format("the screenshot {} cannot be written: {}", name, problem.what());
        }
    }
    return "no screenshot: there are too many in this folder";
}

}  // namespace pogosim
