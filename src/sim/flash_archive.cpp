#include "sim/flash_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <span>
#include <string_view>

#include "base/counted.hpp"
#include "base/fnv_1a.hpp"
#include "base/locked_file.hpp"
#include "device/flash.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kSignature("PGFLASH\0", 8);
constexpr std::uint16_t kVersion = 1;
constexpr std::uint32_t kFlashBytes = kFlashPageCount * kFlashPageBytes;
constexpr std::uint32_t kOldFlashBytes = 65536;  // of robots before version 3
constexpr unsigned kBitsOfByte = 8;

template <class Integer>
void put(std::string& bytes, Integer value) {
    for (unsigned i = 0; i < sizeof(Integer); ++i) {
        bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (kBitsOfByte * i));
    }
}

template <class Integer>
Integer integer_at(std::string_view bytes, std::size_t place) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
        value |= std::uint64_t{static_cast<unsigned char>(bytes[place + i])} << (kBitsOfByte * i);
    }
    return static_cast<Integer>(value);
}

/// Reads an archive from its start to its end.
class Reader {
public:
    explicit Reader(std::istream& file) : file_(file) {}

    void begin_record() { record_.clear(); }
    std::string_view record() const { return record_; }  // what has been read of it

    /// The next bytes, valid until the next read. `part` of the archive, for the message.
    std::string_view bytes(std::size_t count, std::string const& part) {
        std::size_t const before = record_.size();
        record_.resize(before + count);
        file_.read(record_.data() + before, static_cast<std::streamsize>(count));
        auto const found = static_cast<std::size_t>(file_.gcount());
        position_ += found;
        if (found < count) {
            throw FileError(fmt::format("it ends in {}, after {}: it was cut, or is still being copied", part,
                                        counted(position_, "byte")));
        }
        return std::string_view(record_).substr(before);
    }

    template <class Integer>
    Integer integer(std::string const& part) {
        return integer_at<Integer>(bytes(sizeof(Integer), part), 0);
    }

    bool is_at_end() { return file_.peek() == std::istream::traits_type::eof(); }
    std::uint64_t position() const { return position_; }

private:
    std::istream& file_;
    std::string record_;
    std::uint64_t position_ = 0;
};

/// Returns the number of records.
std::uint32_t read_head(Reader& reader) {
    std::string const part = "its first 18 bytes";
    if (reader.is_at_end()) {
        throw FileError("it is empty, not an archive of flash memory");
    }
    if (reader.bytes(kSignature.size(), part) != kSignature) {
        throw FileError("it is not an archive of flash memory: it does not begin with PGFLASH");
    }
    if (auto const version = reader.integer<std::uint16_t>(part); version != kVersion) {
        throw FileError(fmt::format("its version is {}, expected {}", version, kVersion));
    }
    if (auto const size = reader.integer<std::uint32_t>(part); size != kFlashBytes) {
        throw FileError(fmt::format("its robots have {} bytes of flash memory, expected {}{}", size, kFlashBytes,
                                    size == kOldFlashBytes ? "; it is of robots before version 3" : ""));
    }
    return reader.integer<std::uint32_t>(part);
}

void fill_flash(Flash& flash, std::string_view bytes) {
    for (std::uint32_t page = 0; page < kFlashPageCount; ++page) {
        overwrite_page(flash, static_cast<std::uint16_t>(page),
                       reinterpret_cast<std::byte const*>(bytes.data()) + page * kFlashPageBytes);
    }
}

/// `part`: "record 2 of 5".
FlashRecord read_record(Reader& reader, std::string const& part) {
    FlashRecord record;
    reader.begin_record();
    record.owner.id = reader.integer<std::uint16_t>(part);
    record.owner.category = reader.bytes(reader.integer<std::uint16_t>(part), part);
    std::ranges::generate(record.directions, [&] { return reader.integer<std::uint8_t>(part); });
    std::ranges::generate(record.powers, [&] { return reader.integer<std::uint16_t>(part); });
    fill_flash(record.flash, reader.bytes(kFlashBytes, part));
    std::uint64_t const expected = fnv_1a(reader.record());
    if (auto const written = reader.integer<std::uint64_t>(part); written != expected) {
        throw FileError(
            fmt::format("{} is damaged: its checksum is {:016x}, and its bytes have {:016x}", part, written, expected));
    }
    return record;
}

}  // namespace

std::string described(FlashOwner const& owner) {
    return fmt::format("robot #{} of category '{}'", owner.id, owner.category);
}

std::uint32_t read_flash_archive(std::istream& file, std::function<void(FlashRecord&&)> const& take) {
    Reader reader(file);
    std::uint32_t const count = read_head(reader);
    std::set<FlashOwner> owners;
    for (std::uint32_t i = 0; i < count; ++i) {
        FlashRecord record = read_record(reader, fmt::format("record {} of {}", i + 1, count));
        if (!owners.insert(record.owner).second) {
            throw FileError(fmt::format("it has two records of {}", described(record.owner)));
        }
        take(std::move(record));
    }
    if (!reader.is_at_end()) {
        throw FileError(
            fmt::format("bytes follow its last record, which ends after {}", counted(reader.position(), "byte")));
    }
    return count;
}

bool begins_as_flash_archive(std::istream& file) {
    std::string bytes(kSignature.size(), '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file.gcount() == static_cast<std::streamsize>(bytes.size()) && bytes == kSignature;
}

std::string flash_archive_head(std::uint32_t records) {
    std::string bytes(kSignature);
    put(bytes, kVersion);
    put(bytes, kFlashBytes);
    put(bytes, records);
    return bytes;
}

std::string flash_archive_record(FlashRecord const& record) {
    std::string bytes;
    bytes.reserve(kFlashBytes + record.owner.category.size() + 64);
    put(bytes, record.owner.id);
    put(bytes, static_cast<std::uint16_t>(record.owner.category.size()));
    bytes += record.owner.category;
    std::ranges::for_each(record.directions, [&](std::uint8_t direction) { put(bytes, direction); });
    std::ranges::for_each(record.powers, [&](std::uint16_t power) { put(bytes, power); });
    std::size_t const flash = bytes.size();
    bytes.resize(flash + kFlashBytes, static_cast<char>(kErased));
    for (std::uint16_t const page : written_pages(record.flash)) {
        std::memcpy(bytes.data() + flash + page * kFlashPageBytes, page_at(record.flash, page).data(), kFlashPageBytes);
    }
    put(bytes, fnv_1a(bytes));
    return bytes;
}

}  // namespace pogosim
