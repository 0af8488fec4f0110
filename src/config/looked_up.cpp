#include "config/looked_up.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>

namespace pogosim {

namespace {

constinit thread_local LookedUp* of_thread = nullptr;

std::filesystem::file_type noted_type_at(std::filesystem::path const& path) {
    auto const type = file_type_at(path);
    if (of_thread != nullptr) {
        of_thread->note_type(path, type);
    }
    return type;
}

}  // namespace

std::filesystem::file_type file_type_at(std::filesystem::path const& path) {
    std::error_code ignored;
    return std::filesystem::status(path, ignored).type();
}

std::string bytes_at(std::filesystem::path const& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool LookedUp::is_still_there() const {
    return std::ranges::all_of(types_, [](Type const& noted) { return file_type_at(noted.path) == noted.type; }) &&
           std::ranges::all_of(texts_, [](Text const& noted) {
               std::error_code error;  // before a pipe, say, is read
               bool const is_like_it = std::filesystem::is_regular_file(noted.path, error) &&
                                       std::filesystem::file_size(noted.path, error) == noted.text.size();
               return is_like_it && bytes_at(noted.path) == noted.text;
           });
}

std::size_t LookedUp::size() const {
    std::size_t bytes = 0;
    for (Text const& noted : texts_) {
        bytes += noted.text.size();
    }
    return bytes;
}

LookedUpScope::LookedUpScope(LookedUp& looked_up) : before_(of_thread) {
    of_thread = &looked_up;
}

LookedUpScope::~LookedUpScope() {
    of_thread = before_;
}

void note_text_of(std::filesystem::path const& path, std::string const& text) {
    if (of_thread != nullptr) {
        of_thread->note_text(path, text);
    }
}

bool look_for(std::filesystem::path const& path) {
    auto const type = noted_type_at(path);
    return type != std::filesystem::file_type::none && type != std::filesystem::file_type::not_found;
}

bool look_for_folder(std::filesystem::path const& path) {
    return noted_type_at(path) == std::filesystem::file_type::directory;
}

}  // namespace pogosim
