#include "tables/metadata_beside.hpp"

#include <arrow/util/key_value_metadata.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/locked_file.hpp"
#include "base/scratch_file.hpp"
#include "record/paths_beside.hpp"
#include "tables/descriptor_stream.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kBegin = "# Pogosim: metadata of the table beside this file";
constexpr mode_t kNewFile = 0666;  // less the umask

/// A text as a literal block of YAML, indented by two blanks.
std::string block(std::string_view text) {
    bool const ends_line = text.ends_with('\n');
    std::string lines = ends_line ? "|2+\n" : "|2-\n";
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t const end = std::min(text.find('\n', begin), text.size());
        lines += fmt::format("{}{}\n", end > begin ? "  " : "", text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// A name in quotation marks, in one line.
std::string in_quotes(std::string_view name) {
    std::string text = "\"";
    for (char const c : name) {
        bool const is_plain = (static_cast<unsigned char>(c) >= ' ' && c != '\x7f') && c != '"' && c != '\\';
        text += is_plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return text + '"';
}

std::string text_of(arrow::Schema const& schema) {
    std::string text = fmt::format("{}\n", kBegin);
    if (auto const metadata = schema.metadata()) {
        for (std::int64_t i = 0; i < metadata->size(); ++i) {
            text += fmt::format("{}: {}", metadata->key(i), block(metadata->value(i)));
        }
    }
    std::vector<std::string> names;
    std::vector<std::string> types;
    for (auto const& field : schema.fields()) {
        names.push_back(in_quotes(field->name()));
        types.push_back(field->type()->ToString());
    }
    text += fmt::format("column_names: [{}]\n", fmt::join(names, ", "));
    return text + fmt::format("column_types: [{}]\n", fmt::join(types, ", "));
}

std::filesystem::path unfinished_path_of(std::filesystem::path const& table) {
    return metadata_path_of(table).native() + kUnfinishedSuffix;
}

}  // namespace

bool MetadataBeside::is_taken(std::filesystem::path const& table) {
    auto const path = metadata_path_of(table);
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(path, error))) {
        return false;
    }
    if (!std::filesystem::is_regular_file(path, error)) {
        return true;
    }
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line != kBegin;
}

bool MetadataBeside::has_short_name(std::filesystem::path const& table) {
    std::filesystem::path const path = unfinished_path_of(table);
    long const most_bytes = pathconf(path.parent_path().c_str(), _PC_NAME_MAX);
    return most_bytes < 0 || path.filename().native().size() <= static_cast<std::size_t>(most_bytes);
}

arrow::Result<std::unique_ptr<MetadataBeside>> MetadataBeside::write(std::filesystem::path const& table,
                                                                     arrow::Schema const& schema, bool sync) {
    std::filesystem::path const path = unfinished_path_of(table);
    int const descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, kNewFile);
    if (descriptor < 0) {
        return system_error(errno);
    }
    std::unique_ptr<MetadataBeside> metadata(new MetadataBeside(path));
    DescriptorStream stream(descriptor);
    std::string const text = text_of(schema);
    arrow::Status status = stream.Write(text.data(), static_cast<std::int64_t>(text.size()));
    if (status.ok()) {
        status = stream.Flush();
    }
    if (status.ok() && sync && fsync(descriptor) != 0) {
        status = system_error(errno);
    }
    close(descriptor);
    ARROW_RETURN_NOT_OK(status);
    return metadata;
}

arrow::Status MetadataBeside::belong_to(std::filesystem::path const& table) {
    if (std::rename(path_.c_str(), metadata_path_of(table).c_str()) != 0) {
        return system_error(errno);
    }
    scratch_.release();
    return arrow::Status::OK();
}

}  // namespace pogosim
