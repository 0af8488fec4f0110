// Flash memory through the functions of a robot.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "device/flash.hpp"
#include "support/lone_robot.hpp"

namespace pogosim {
namespace {

static_assert(POGOBOT_USER_FLASH_START_OFFSET == 0x90000U);
static_assert(POGOBOT_USER_FLASH_PAGE_SIZE * POGOBOT_USER_FLASH_PAGE_COUNT == 1472U * 1024U);
static_assert(POGOBOT_USER_FLASH_START_OFFSET + POGOBOT_USER_FLASH_PAGE_SIZE * POGOBOT_USER_FLASH_PAGE_COUNT ==
              0x200000U);  // the whole chip: 2 MiB

using testing::run_alone;

std::array<char, POGOBOT_USER_FLASH_PAGE_SIZE> seen;  // what the robot has read last

void store_seven() {
    std::array<char, POGOBOT_USER_FLASH_PAGE_SIZE> page{};
    page[0] = 7;
    write_page_flash(12, page.data());
}

TEST(Flash, RobotReadsWhatItHasWritten) {
    seen.fill(0);
    run_alone(
        testing::article_robot(), store_seven, [] { read_page_flash(12, seen.data()); }, 0.1);
    EXPECT_EQ(seen[0], 7);
    EXPECT_EQ(seen[1], 0);
    run_alone(
        testing::article_robot(), store_seven,
        [] {
            erase_write_section_flash();
            read_page_flash(12, seen.data());
        },
        0.1);
    EXPECT_EQ(seen[0], static_cast<char>(0xFF));
}

TEST(Flash, EveryRunStartsBlank) {
    run_alone(
        testing::article_robot(), store_seven, [] {}, 0.1);
    run_alone(
        testing::article_robot(), [] {}, [] { read_page_flash(12, seen.data()); }, 0.1);
    EXPECT_EQ(seen[0], static_cast<char>(0xFF));
}

TEST(Flash, UnknownPagesAreNeitherReadNorWritten) {
    seen.fill(33);
    auto const simulation = run_alone(
        testing::article_robot(), [] {},
        [] {
            write_page_flash(POGOBOT_USER_FLASH_PAGE_COUNT, seen.data());
            write_page_flash(UINT16_MAX, seen.data());
            read_page_flash(POGOBOT_USER_FLASH_PAGE_COUNT, seen.data());
        },
        0.1);
    EXPECT_EQ(seen[0], 33);
    EXPECT_TRUE(simulation->world().devices.flash[0].pages.empty());
}

TEST(Flash, RobotsHaveTheirOwn) {
    testing::use_program(
        [] {
            std::array<char, POGOBOT_USER_FLASH_PAGE_SIZE> page{};
            page[0] = static_cast<char>(pogobot_helper_getid());
            write_page_flash(1, page.data());
        },
        [] {
            std::array<char, POGOBOT_USER_FLASH_PAGE_SIZE> page{};
            read_page_flash(1, page.data());
            mydata->number[0] = page[0] == static_cast<char>(pogobot_helper_getid()) ? 1 : -1;
        });
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(20)}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.1));
    for (std::size_t robot = 0; robot < 20; ++robot) {
        auto const* const data =
            reinterpret_cast<TestData const*>(simulation.controllers().controller_of(robot).user_data);
        EXPECT_EQ(data->number[0], 1);
    }
}

TEST(Flash, HashTellsWhatIsWrittenAndNotHow) {
    auto const hash_after = [](void (*init)()) {
        return run_alone(
                   testing::article_robot(), init, [] {}, 0.1)
            ->hash();
    };
    std::uint64_t const blank = hash_after([] {});
    std::uint64_t const seven = hash_after(store_seven);
    EXPECT_NE(seven, blank);
    EXPECT_EQ(hash_after([] {
                  store_seven();
                  erase_write_section_flash();
              }),
              blank);
    EXPECT_EQ(hash_after([] {
                  std::array<char, POGOBOT_USER_FLASH_PAGE_SIZE> page{};
                  write_page_flash(5000, page.data());
                  page.fill(static_cast<char>(0xFF));
                  store_seven();
                  write_page_flash(5000, page.data());
              }),
              seven);
}

}  // namespace
}  // namespace pogosim
