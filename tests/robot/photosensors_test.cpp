// What the three light sensors tell a program.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "lamps/spot_lamp.hpp"
#include "support/lone_robot.hpp"

namespace pogosim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr int kCells = 100;  // columns and rows of the light map
constexpr std::size_t kSensors = 3;

SpotSpec plane_lamp(float angle_rad, int far_value) {
    SpotSpec lamp;
    lamp.shape.kind = ShapeKind::global;
    lamp.mode = LightMode::plane;
    lamp.value = 0;
    lamp.edge_value = far_value;
    lamp.centre_mm = {500, 500};
    lamp.plane_angle_rad = angle_rad;
    lamp.plane_half_span_mm = 500.0F;
    return lamp;
}

SpotSpec even_lamp(int value) {
    SpotSpec lamp;
    lamp.shape.kind = ShapeKind::global;
    lamp.value = value;
    return lamp;
}

/// Two lamps over an arena of 1 m that give each cell a level of its own: see cell_level().
std::vector<ObjectConfig> lamps_that_number_cells() {
    return {testing::lamp(plane_lamp(0.0F, 2 * kCells)),
            testing::lamp(plane_lamp(static_cast<float>(kPi) / 2.0F, 200 * kCells))};
}

/// Level in the middle of a cell: the lamps rise by 2 a column and by 200 a row.
int cell_level(int column, int row) {
    return (2 * column + 1) + (200 * row + 100);
}

std::vector<std::array<int, 4>> readings;  // by robot id

void read_photosensors() {
    main_loop_hz = 0;  // a tick at each step
    readings.resize(std::max<std::size_t>(readings.size(), pogobot_helper_getid() + std::size_t{1}));
    for (uint8_t i = 0; i < 4; ++i) {
        readings[pogobot_helper_getid()][i] = pogobot_photosensors_read(i);
    }
}

void circle() {
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorHalf);
}

/// Where a sensor is, by the documentation.
std::array<double, 2> sensor_place_mm(Bodies const& bodies, std::size_t body, double sensor_degrees) {
    double const bearing = bodies.heading_rad[body] + sensor_degrees * kDegree;
    return {bodies.position_mm[body].x + bodies.radius_mm[body] * std::cos(bearing),
            bodies.position_mm[body].y + bodies.radius_mm[body] * std::sin(bearing)};
}

/// The column or row of a coordinate, -1 so near a border of cells that rounding decides.
int cell_of(double coordinate_mm) {
    constexpr double cell_mm = 1000.0 / kCells;
    double const cells = std::clamp(coordinate_mm / cell_mm, 0.0, kCells - 0.5);
    return std::abs(cells - std::round(cells)) < 1e-3 && cells > 0.0 ? -1 : static_cast<int>(cells);
}

TEST(Photosensors, ShowTheCellsUnderTheirPlacesOnTheRim) {
    std::vector<ObjectConfig> objects = lamps_that_number_cells();
    for (float const radius_mm : {10.0F, 26.5F, 60.0F}) {
        ObjectSpec spec = testing::article_robot();
        spec.shape.radius_mm = radius_mm;
        objects.push_back(testing::robots(15, spec, "robots" + std::to_string(static_cast<int>(radius_mm))));
    }
    testing::program_main = [] {
        for (char const* category : {"robots10", "robots26", "robots60"}) {
            pogobot_start(circle, read_photosensors, category);
        }
    };
    Simulation simulation(testing::test_program(), testing::square_scene(objects), {});
    ASSERT_FALSE(simulation.start());
    readings.clear();
    int compared = 0;
    std::set<int> seen;
    for (int step = 0; step < 500; ++step) {
        Bodies const before = simulation.world().bodies;
        ASSERT_FALSE(simulation.step());
        if (step < 2) {
            continue;  // the first tick still sleeps
        }
        for (std::size_t robot = 0; robot < before.size(); ++robot) {
            EXPECT_EQ(readings[robot][3], -1);
            for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
                constexpr std::array degrees{180.0, 320.0, 40.0};  // back, front left, front right
                auto const [x, y] = sensor_place_mm(before, robot, degrees[sensor]);
                if (cell_of(x) < 0 || cell_of(y) < 0) {
                    continue;
                }
                ASSERT_EQ(readings[robot][sensor], cell_level(cell_of(x), cell_of(y)))
                    << "sensor " << sensor << " at " << x << ", " << y;
                seen.insert(readings[robot][sensor]);
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 60'000);
    EXPECT_GT(seen.size(), 1500U);  // different cells
}

/// The readings of a robot of 26.5 mm that stands there and looks to the right.
std::array<int, 4> readings_at(Vec2 position_mm, BoundaryCondition boundary) {
    std::vector<ObjectConfig> objects = lamps_that_number_cells();
    objects.push_back(testing::robot_at(position_mm));
    testing::use_program(read_photosensors, nullptr);
    Scenario scenario = testing::square_scene(objects);
    scenario.boundary = boundary;
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    readings.clear();
    EXPECT_FALSE(simulation.start());
    return readings.at(0);
}

TEST(Photosensors, BeyondTheMapShowItsOutermostCell) {
    std::array<int, 4> const seen = readings_at({995, 505}, BoundaryCondition::solid);
    EXPECT_EQ(seen[p_B], cell_level(96, 50));
    EXPECT_EQ(seen[p_FL], cell_level(99, 48));
    EXPECT_EQ(seen[p_FR], cell_level(99, 52));
}

TEST(Photosensors, BeyondTheSeamOfAPeriodicArenaShowTheOtherSide) {
    // Sensors are 20.3 mm ahead of the centre and 17.0 mm to the sides, or 26.5 mm behind.
    std::array<int, 4> const seen = readings_at({995, 5}, BoundaryCondition::periodic);
    EXPECT_EQ(seen[p_B], cell_level(96, 0));
    EXPECT_EQ(seen[p_FL], cell_level(1, 98));
    EXPECT_EQ(seen[p_FR], cell_level(1, 2));
}

TEST(Photosensors, BiasIsDrawnOncePerSensorEvenlyFromItsDomain) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->photosensor_bias = {-30, 50};
    testing::use_program(circle, read_photosensors);
    Simulation simulation(testing::test_program(),
                          testing::square_scene({testing::robots(400, spec), testing::lamp(even_lamp(1000))}, 4000.0),
                          {});
    ASSERT_FALSE(simulation.start());
    readings.clear();
    ASSERT_FALSE(testing::run_for(simulation, 0.02));
    auto const first = readings;
    ASSERT_FALSE(testing::run_for(simulation, 0.5));
    EXPECT_EQ(readings, first);

    std::vector<double> biases;
    int equal_pairs = 0;
    for (auto const& robot : readings) {
        for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
            biases.push_back(robot[sensor] - 1000.0);
            equal_pairs += robot[sensor] == robot[(sensor + 1) % kSensors] ? 1 : 0;
        }
    }
    auto const [lowest, highest] = std::minmax_element(biases.begin(), biases.end());
    EXPECT_EQ(*lowest, -30.0);  // each of the 81 values comes 15 times on average
    EXPECT_EQ(*highest, 50.0);
    double const n = static_cast<double>(biases.size());
    double const mean = std::accumulate(biases.begin(), biases.end(), 0.0) / n;
    double squares = 0.0;
    for (double const bias : biases) {
        squares += std::pow(bias - 10.0, 2);
    }
    // Variance of an even draw of k values: (k^2 - 1) / 12. Its own spread: kurtosis 1.8.
    double const variance = (81.0 * 81.0 - 1.0) / 12.0;
    EXPECT_NEAR(mean, 10.0, 4.0 * std::sqrt(variance / n));
    EXPECT_NEAR(squares / n, variance, 4.0 * variance * std::sqrt(0.8 / n));
    EXPECT_NEAR(equal_pairs / n, 1.0 / 81.0, 4.0 * std::sqrt(1.0 / 81.0 / n));
}

TEST(Photosensors, NoiseIsNormalAndFreshAtEachReading) {
    static std::vector<std::array<int, 3>> triples;
    triples.clear();
    ObjectSpec spec = testing::article_robot();
    spec.robot->photosensor_noise_stddev = 50.0F;
    spec.robot->photosensor_bias = {100, 100};
    testing::use_program(nullptr, [] {
        // Twice the same sensor, then another one.
        triples.push_back(
            {pogobot_photosensors_read(p_B), pogobot_photosensors_read(p_B), pogobot_photosensors_read(p_FR)});
    });
    Simulation simulation(testing::test_program(),
                          testing::square_scene({testing::robots(20, spec), testing::lamp(even_lamp(1000))}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 5.0));

    double const n = static_cast<double>(triples.size());
    std::array<double, 3> sum{};
    std::array<double, 3> squares{};
    std::array<double, 3> within_one_stddev{};
    std::array<double, 3> products{};
    for (auto const& triple : triples) {
        for (std::size_t i = 0; i < 3; ++i) {
            double const noise = triple[i] - 1100.0;
            sum[i] += noise;
            squares[i] += noise * noise;
            within_one_stddev[i] += std::abs(noise) < 50.0 ? 1.0 : 0.0;
            products[i] += noise * (triple[(i + 1) % 3] - 1100.0);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(sum[i] / n, 0.0, 4.0 * 50.0 / std::sqrt(n));
        // Cutting the fraction off takes half a count from each deviation.
        EXPECT_NEAR(std::sqrt(squares[i] / n), 49.6, 4.0 * 50.0 / std::sqrt(2.0 * n));
        EXPECT_NEAR(within_one_stddev[i] / n, 0.6827, 4.0 * std::sqrt(0.6827 * 0.3173 / n));
        EXPECT_NEAR(products[i] / n, 0.0, 4.0 * 2500.0 / std::sqrt(n));
    }
}

TEST(Photosensors, EndAtTheLargestNumberOf16Bits) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->photosensor_bias = {1000, 1000};
    testing::use_program(read_photosensors, nullptr);
    Simulation bright(testing::test_program(),
                      testing::square_scene({testing::robots(1, spec), testing::lamp(even_lamp(32000))}), {});
    ASSERT_FALSE(bright.start());
    EXPECT_EQ(readings[0], (std::array{32767, 32767, 32767, -1}));
}

}  // namespace
}  // namespace pogosim
