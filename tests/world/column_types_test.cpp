// The table of the types of users' columns.
#include "world/data_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace pogosim {
namespace {

constexpr ColumnType kAll[] = {ColumnType::int8,    ColumnType::int16,   ColumnType::int32,
                               ColumnType::int64,   ColumnType::float16, ColumnType::float32,
                               ColumnType::float64, ColumnType::boolean, ColumnType::text};

ColumnSpec column(ColumnType type) {
    return {.name = "c", .type = type};
}

CellValue cell(ColumnType type, double value) {
    return row_of(type).cell_of(column(type), value);
}

bool refuses(ColumnType type, double value) {
    try {
        static_cast<void>(cell(type, value));
        return false;
    } catch (ConfigError const&) {
        return true;
    }
}

template <class Number>
Number written(ColumnType type, CellValue const& value) {
    EXPECT_EQ(row_of(type).bytes, sizeof(Number));
    std::vector<std::byte> place(row_of(type).bytes);
    row_of(type).write(place.data(), value);
    Number number{};
    std::memcpy(&number, place.data(), sizeof(number));
    return number;
}

template <class Integer>
void expect_all_integers_and_no_others(ColumnType type) {
    auto const low = static_cast<double>(std::numeric_limits<Integer>::min());
    double const high = -low - 1.0;  // rounded up where a double does not have it
    EXPECT_EQ(written<Integer>(type, cell(type, low)), std::numeric_limits<Integer>::min());
    EXPECT_EQ(written<Integer>(type, cell(type, -7.0)), -7);
    EXPECT_EQ(written<Integer>(type, {}), 0);
    EXPECT_TRUE(refuses(type, low * 2.0));
    EXPECT_TRUE(refuses(type, high + 1.0));
    EXPECT_TRUE(refuses(type, 0.5));
    EXPECT_EQ(cell(type, std::nan("")), CellValue());
    EXPECT_TRUE(refuses(type, std::numeric_limits<double>::infinity()));
}

TEST(ColumnTypes, EachHasItsRow) {
    for (ColumnType const type : kAll) {
        EXPECT_EQ(row_of(type).type, type);
    }
    EXPECT_EQ(std::size(kAll), 9U);
}

TEST(ColumnTypes, OfIntegersTakeWholeNumbersOfTheirRange) {
    expect_all_integers_and_no_others<std::int8_t>(ColumnType::int8);
    expect_all_integers_and_no_others<std::int16_t>(ColumnType::int16);
    expect_all_integers_and_no_others<std::int32_t>(ColumnType::int32);
    expect_all_integers_and_no_others<std::int64_t>(ColumnType::int64);
    EXPECT_EQ(written<std::int8_t>(ColumnType::int8, cell(ColumnType::int8, 127.0)), 127);
    EXPECT_EQ(written<std::int32_t>(ColumnType::int32, cell(ColumnType::int32, 2147483647.0)), 2147483647);
}

TEST(ColumnTypes, OfRealNumbersTakeAllAndWriteNoneAsNotANumber) {
    EXPECT_EQ(written<double>(ColumnType::float64, cell(ColumnType::float64, 0.1)), 0.1);
    EXPECT_EQ(written<float>(ColumnType::float32, cell(ColumnType::float32, 0.1)), 0.1F);
    EXPECT_EQ(written<std::uint16_t>(ColumnType::float16, cell(ColumnType::float16, 1.0)), 0x3C00);
    EXPECT_TRUE(std::isnan(written<double>(ColumnType::float64, {})));
    EXPECT_TRUE(std::isnan(written<float>(ColumnType::float32, {})));
    EXPECT_GT(written<std::uint16_t>(ColumnType::float16, {}) & 0x7FFF, 0x7C00);
}

TEST(ColumnTypes, OfRealNumbersRefuseWhatWouldBecomeInfinite) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(refuses(ColumnType::float32, 1e300));
    EXPECT_TRUE(refuses(ColumnType::float32, -1e39));
    EXPECT_TRUE(refuses(ColumnType::float16, 65520.0));
    EXPECT_FALSE(refuses(ColumnType::float16, -65519.0));  // rounded to 65504
    EXPECT_EQ(written<double>(ColumnType::float64, cell(ColumnType::float64, 1e300)), 1e300);
    EXPECT_EQ(written<float>(ColumnType::float32, cell(ColumnType::float32, 1e38)), 1e38F);
    EXPECT_EQ(written<float>(ColumnType::float32, cell(ColumnType::float32, infinity)),
              std::numeric_limits<float>::infinity());
}

TEST(ColumnTypes, OfTruthTakeZeroAndOneAndOfTextNoNumber) {
    EXPECT_EQ(written<bool>(ColumnType::boolean, cell(ColumnType::boolean, 1.0)), true);
    EXPECT_EQ(written<bool>(ColumnType::boolean, cell(ColumnType::boolean, 0.0)), false);
    EXPECT_EQ(written<bool>(ColumnType::boolean, {}), false);
    EXPECT_TRUE(refuses(ColumnType::boolean, 2.0));
    EXPECT_TRUE(refuses(ColumnType::text, 0.0));
    EXPECT_EQ(row_of(ColumnType::text).bytes, 0U);
}

}  // namespace
}  // namespace pogosim
