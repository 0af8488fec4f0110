// The file of `flash_state`: what robots keep while they are off. Little-endian, without padding:
//
//     8 bytes  "PGFLASH\0"
//     u16      version, 1
//     u32      bytes of flash memory of each robot, 1507328
//     u32      number of records; then for each of them:
//       u16      id of the robot
//       u16      length of the name of its category, and the name, UTF-8
//       3 x u8   directions of the motors that it has stored: right, left, back
//       3 x u16  powers
//       ...      flash memory, page 0 first
//       u64      FNV-1a over all bytes of this record so far
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <istream>
#include <string>

#include "world/devices.hpp"

namespace pogosim {

/// Whose record it is.
struct FlashOwner {
    std::string category;
    std::uint16_t id = 0;

    friend auto operator<=>(FlashOwner const&, FlashOwner const&) = default;
};

struct FlashRecord {
    FlashOwner owner;
    std::array<std::uint8_t, kMotorCount> directions{};
    std::array<std::uint16_t, kMotorCount> powers{};
    Flash flash;
};

/// "robot #3 of category 'robots'".
std::string described(FlashOwner const& owner);

/// Calls `take` for each record, in the order of the archive, once its checksum is right. Throws FileError for anything
/// that is not as above: whatever `take` was given before then is to be discarded. Returns the number of records.
std::uint32_t read_flash_archive(std::istream& file, std::function<void(FlashRecord&&)> const& take);

/// Whether a file begins as an archive does.
bool begins_as_flash_archive(std::istream& file);

/// The bytes in front of the first record.
std::string flash_archive_head(std::uint32_t records);

/// The bytes of a record.
std::string flash_archive_record(FlashRecord const& record);

}  // namespace pogosim
