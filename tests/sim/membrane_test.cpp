// Membranes hold: they keep their area, let no body through, and stay at rest when nothing pushes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "support/objects.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

/// In the middle of a square of 1 m.
ObjectConfig membrane(bool segments) {
    return testing::at(testing::membrane(segments), {500, 500});
}

/// Around a place, far enough from each other.
std::vector<ObjectConfig> robots_around(Vec2 centre, int count, float distance_mm) {
    std::vector<ObjectConfig> result;
    for (int i = 0; i < count; ++i) {
        Vec2 const offset = distance_mm * direction(6.2831853F * static_cast<float>(i) / static_cast<float>(count));
        result.push_back(testing::robot_at(centre + offset));
    }
    return result;
}

Scenario scene(std::vector<ObjectConfig> const& membranes, std::vector<ObjectConfig> robots, double side_mm = 1000.0) {
    robots.insert(robots.begin(), membranes.begin(), membranes.end());
    return testing::square_scene(std::move(robots), side_mm);
}

/// Robots that start to all sides and push on for ever, turning away now and then.
void push_everywhere() {
    testing::program_main = [] {
        pogobot_start([] { srand(static_cast<unsigned>(pogobot_helper_getRandSeed())); },
                      [] {
                          if (pogobot_ticks % 200 == 0) {  // a turn to anywhere, then 3 s ahead
                              mydata->number[0] = 10 + rand() % 90;
                          }
                          bool const turns = --mydata->number[0] > 0;
                          pogobot_motor_set(motorL, motorFull);
                          pogobot_motor_set(motorR, turns ? motorStop : motorFull);
                      });
        pogobot_start(nullptr, nullptr, "membranes");
    };
}

/// All robots drive along +x and never stop.
void push_to_the_right() {
    testing::program_main = [] {
        pogobot_start(
            [] {
                pogobot_motor_set(motorL, motorFull);
                pogobot_motor_set(motorR, motorFull);
            },
            nullptr);
        pogobot_start(nullptr, nullptr, "membranes");
    };
}

void stand_still() {
    testing::program_main = [] {
        pogobot_start(nullptr, nullptr);
        pogobot_start(nullptr, nullptr, "membranes");
    };
}

Polygon line_of(World const& world, Membrane const& membrane) {
    auto const first = world.bodies.position_mm.begin() + membrane.body;
    return {first, first + membrane.body_count};
}

/// Watches a simulation: the bodies inside each membrane, areas, finite numbers.
class Watch {
public:
    explicit Watch(Scenario scenario) : simulation_(testing::test_program(), std::move(scenario), {}) {
        EXPECT_FALSE(simulation_.start());
        for (Membrane const& membrane : world().membranes) {
            first_areas_.push_back(signed_area(line_of(world(), membrane)));
        }
        first_regions_ = regions();
    }

    World const& world() const { return simulation_.world(); }
    std::size_t inside_at_first() const {
        return static_cast<std::size_t>(std::count(first_regions_.begin(), first_regions_.end(), true));
    }
    double smallest_area() const { return smallest_; }  // in parts of the first one
    double largest_area() const { return largest_; }

    /// Looks every 0.1 s.
    void run_for(double seconds) {
        for (int looks = 0; looks < std::lround(seconds / 0.1) && !::testing::Test::HasFailure(); ++looks) {
            ASSERT_FALSE(testing::run_for(simulation_, 0.1));
            look();
        }
    }

    float fastest_mm_s() const {
        float fastest = 0.0F;
        for (Vec2 const velocity : world().bodies.velocity_mm_s) {
            fastest = std::max(fastest, length(velocity));
        }
        return fastest;
    }

    /// Sum over all bodies, (mm/s)^2.
    double squared_speeds() const {
        double sum = 0.0;
        for (Vec2 const velocity : world().bodies.velocity_mm_s) {
            sum += squared_length(velocity);
        }
        return sum;
    }

private:
    /// For each robot with wheels and each membrane: is it inside?
    std::vector<bool> regions() const {
        std::vector<bool> inside;
        for (Membrane const& membrane : world().membranes) {
            Polygon const line = line_of(world(), membrane);
            for (std::size_t i = 0; i < world().robots.size(); ++i) {
                if (world().spec_of(i).model.has_motors()) {
                    inside.push_back(contains(line, world().bodies.position_mm[world().robots.body[i]]));
                }
            }
        }
        return inside;
    }

    void look() {
        EXPECT_EQ(regions(), first_regions_) << "a body got through before " << world().time_s() << " s";
        for (std::size_t i = 0; i < first_areas_.size(); ++i) {
            double const part = signed_area(line_of(world(), world().membranes[i])) / first_areas_[i];
            smallest_ = std::min(smallest_, part);
            largest_ = std::max(largest_, part);
        }
        for (Vec2 const position : world().bodies.position_mm) {
            ASSERT_TRUE(std::isfinite(position.x) && std::isfinite(position.y));
            if (!world().periodic) {
                ASSERT_TRUE(world().arena.contains(position)) << position.x << ", " << position.y;
            }
        }
    }

    Simulation simulation_;
    std::vector<bool> first_regions_;
    std::vector<double> first_areas_;
    double smallest_ = 1.0;
    double largest_ = 1.0;
};

void expect_kept_area(Watch const& watch) {
    EXPECT_GT(watch.smallest_area(), 0.9);
    EXPECT_LT(watch.largest_area(), 1.1);
}

TEST(Membrane, KeepsItsAreaForAMinuteOfBeingPushedFromInside) {
    for (bool const segments : {false, true}) {
        push_everywhere();
        Watch watch(scene({membrane(segments)}, robots_around({500, 500}, 6, 90.0F)));
        ASSERT_EQ(watch.inside_at_first(), 6U);
        watch.run_for(60.0);
        expect_kept_area(watch);
    }
}

TEST(Membrane, LetsNoBodyInAndKeepsItsAreaForAMinuteOfBeingPushedFromOutside) {
    for (bool const segments : {false, true}) {
        push_everywhere();
        Watch watch(scene({membrane(segments)}, robots_around({500, 500}, 24, 260.0F)));
        ASSERT_EQ(watch.inside_at_first(), 0U);
        watch.run_for(60.0);
        expect_kept_area(watch);
    }
}

TEST(Membrane, HoldsInEveryShapeAndMake) {
    struct Make {
        ShapeKind kind;
        int dots;
        float dot_radius_mm;
        int cross_span;
        float stiffness_hz;
        float damping;
        float density;
    };
    std::vector<Make> const makes{
        {ShapeKind::disk, 40, 10.0F, 0, 30.0F, 0.0F, 10.0F},
        {ShapeKind::rectangle, 60, 5.0F, 1, 30.0F, 5.0F, 10.0F},
        {ShapeKind::triangle, 80, 8.0F, 3, 30.0F, 0.3F, 10.0F},
        {ShapeKind::disk, 150, 5.0F, 0, 1.0F, 0.0F, 10.0F},           // as soft as can be
        {ShapeKind::rectangle, 60, 3.0F, 2, 1000.0F, 0.3F, 1.0F},     // much stiffer than the time step allows
        {ShapeKind::disk, 200, 2.0F, 1, 30.0F, 0.3F, 1.0F},           // dots a thousand times lighter than robots
        {ShapeKind::rectangle, 100, 5.0F, 0, 30.0F, 0.0F, 1e-30F},    // as light as nothing
        {ShapeKind::triangle, 150, 20.0F, 5, 10000.0F, 1.0F, 100.0F}  // fat dots that overlap in the corners
    };
    for (bool const segments : {false, true}) {
        for (std::size_t i = 0; i < makes.size(); ++i) {
            SCOPED_TRACE(::testing::Message() << (segments ? "segments, make " : "dots, make ") << i);
            Make const& make = makes[i];
            ObjectConfig object = membrane(segments);
            object.spec.shape = {.kind = make.kind, .radius_mm = 180, .width_mm = 320, .height_mm = 300};
            object.spec.shape.side_length_mm = 520;
            object.spec.membrane->body_count = make.dots;
            object.spec.membrane->radius_mm = make.dot_radius_mm;
            object.spec.membrane->cross_span = make.cross_span;
            object.spec.membrane->stiffness_hz = make.stiffness_hz;
            object.spec.body->linear_damping = make.damping;
            object.spec.body->density = make.density;
            push_everywhere();
            std::vector<ObjectConfig> robots = robots_around({500, 500}, 3, 55.0F);
            for (ObjectConfig const& outside : robots_around({500, 500}, 8, 400.0F)) {
                robots.push_back(outside);
            }
            Watch watch(scene({object}, robots));
            ASSERT_EQ(watch.inside_at_first(), 3U);
            watch.run_for(6.0);
            expect_kept_area(watch);
        }
    }
}

/// Ten robots of this make in a membrane of 250 mm, all full ahead, each to a side of its own.
Scenario fast_scene(bool segments, float radius_mm, float speed_mm_s, double time_step_s) {
    ObjectConfig soft = membrane(segments);
    soft.spec.shape.radius_mm = 250.0F;
    soft.spec.membrane->body_count = 120;
    std::vector<ObjectConfig> robots = robots_around({500, 500}, 9, 140.0F);
    robots.push_back(testing::robot_at({500, 500}));
    for (std::size_t i = 0; i < robots.size(); ++i) {
        robots[i].spec.shape.radius_mm = radius_mm;
        robots[i].spec.robot->max_linear_speed_mm_s = speed_mm_s;
        robots[i].heading_rad = 1.7F * static_cast<float>(i);
    }
    Scenario scenario = scene({soft}, robots);
    scenario.time_step_s = time_step_s;
    return scenario;
}

TEST(Membrane, HoldsAtEverySpeedSizeAndStepOrRefusesToStart) {
    int held = 0;
    int refused = 0;
    push_to_the_right();
    for (bool const segments : {false, true}) {
        for (float const radius_mm : {5.0F, 40.0F}) {
            for (float const speed_mm_s : {100.0F, 3000.0F, 1e4F, 1e5F}) {
                for (double const time_step_s : {0.001, 0.01, 0.05}) {
                    SCOPED_TRACE(::testing::Message() << (segments ? "segments, " : "dots, ") << radius_mm << " mm, "
                                                      << speed_mm_s << " mm/s, " << time_step_s << " s");
                    try {
                        Watch watch(fast_scene(segments, radius_mm, speed_mm_s, time_step_s));
                        ASSERT_EQ(watch.inside_at_first(), 10U);
                        watch.run_for(time_step_s < 0.01 ? 0.1 : 0.4);
                        ++held;
                    } catch (ConfigError const& error) {
                        std::string const message = error.what();
                        EXPECT_NE(message.find("that a membrane can hold back. Use at most "), std::string::npos)
                            << message;
                        ++refused;
                    }
                }
            }
        }
    }
    EXPECT_GE(held, 24);
    EXPECT_GE(refused, 8);
}

TEST(Membrane, HoldsRobotsThatNoiseMakesFasterThanAnyMotor) {
    // Some 100 m/s, more than sub-steps can follow.
    push_to_the_right();
    for (bool const segments : {false, true}) {
        Scenario scenario = fast_scene(segments, 40.0F, 1000.0F, 0.01);
        for (ObjectConfig& object : scenario.objects) {
            object.spec.robot->linear_noise_stddev = 1000.0F;  // times 100 mm/s
        }
        Watch watch(std::move(scenario));
        watch.run_for(0.3);
    }
}

TEST(Membrane, HoldsWhenAllPushToOneSide) {
    for (bool const segments : {false, true}) {
        push_to_the_right();
        Watch watch(scene({membrane(segments)}, robots_around({500, 500}, 8, 110.0F)));
        watch.run_for(12.0);  // across the arena, then against its wall
        expect_kept_area(watch);
        float right_mm = 0.0F;
        for (Vec2 const position : watch.world().bodies.position_mm) {
            right_mm = std::max(right_mm, position.x);
        }
        EXPECT_GT(right_mm, 950.0F);
    }
}

TEST(Membrane, FreeOneStaysAtRest) {
    for (bool const segments : {false, true}) {
        for (float const damping : {0.0F, 5.0F}) {
            stand_still();
            ObjectConfig object = membrane(segments);
            object.spec.body->linear_damping = damping;
            Watch watch(scene({object}, {testing::robot_at({60, 60})}));
            std::vector<Vec2> const before = watch.world().bodies.position_mm;
            watch.run_for(3.0);
            EXPECT_EQ(watch.fastest_mm_s(), 0.0F);  // asleep, so that it costs nothing
            for (std::size_t i = 0; i < before.size(); ++i) {
                EXPECT_LT(length(watch.world().bodies.position_mm[i] - before[i]), 0.1F);
            }
        }
    }
}

TEST(Membrane, CalmsDownWhenPushingEnds) {
    for (bool const segments : {false, true}) {
        testing::program_main = [] {
            pogobot_start(
                [] {
                    pogobot_motor_set(motorL, motorFull);
                    pogobot_motor_set(motorR, motorFull);
                },
                [] {
                    if (pogobot_ticks == 100) {
                        pogobot_motor_set(motorL, motorStop);
                        pogobot_motor_set(motorR, motorStop);
                    }
                });
            pogobot_start(nullptr, nullptr, "membranes");
        };
        ObjectConfig object = membrane(segments);
        object.spec.body->linear_damping = 0.3F;
        Watch watch(scene({object}, robots_around({500, 500}, 6, 90.0F)));
        watch.run_for(1.5);
        double const pushed = watch.squared_speeds();
        EXPECT_GT(pushed, 1e4);
        watch.run_for(6.0);
        EXPECT_LT(watch.squared_speeds(), 0.1 * pushed);
    }
}

TEST(Membrane, HoldsInALongNarrowArena) {
    for (bool const segments : {false, true}) {
        push_everywhere();
        ObjectConfig object = membrane(segments);
        object.spec.shape = {.kind = ShapeKind::rectangle, .width_mm = 900, .height_mm = 120};
        object.position_mm = Vec2{2500, 100};
        Scenario scenario = scene(
            {object}, {testing::robot_at({2200, 100}), testing::robot_at({2400, 100}), testing::robot_at({2800, 100}),
                       testing::robot_at({500, 100}), testing::robot_at({4500, 100}), testing::robot_at({4700, 100})});
        scenario.arena_file = std::string(POGOSIM_SOURCE_DIR) + "/tests/sim/corridor.csv";
        scenario.arena_surface_mm2 = 5000.0 * 200.0;
        Watch watch(std::move(scenario));
        ASSERT_EQ(watch.inside_at_first(), 3U);
        watch.run_for(20.0);
        expect_kept_area(watch);
    }
}

TEST(Membrane, SeveralPushEachOtherWithoutMixing) {
    std::vector<ObjectConfig> membranes;
    std::vector<ObjectConfig> robots;
    for (int i = 0; i < 4; ++i) {
        ObjectConfig object = membrane(i % 2 == 0);
        object.spec.shape.radius_mm = 180.0F;
        object.spec.membrane->body_count = 60;
        object.position_mm = Vec2{250.0F + 500.0F * static_cast<float>(i % 2), i < 2 ? 250.0F : 750.0F};
        for (ObjectConfig const& robot : robots_around(*object.position_mm, 5, 80.0F)) {
            robots.push_back(robot);
        }
        membranes.push_back(object);
    }
    for (ObjectConfig const& robot : robots_around({500, 500}, 4, 50.0F)) {
        robots.push_back(robot);
    }
    push_everywhere();
    Watch watch(scene(membranes, robots));
    ASSERT_EQ(watch.inside_at_first(), 20U);
    watch.run_for(20.0);
    expect_kept_area(watch);
}

TEST(Membrane, CrossesTheSeamOfAPeriodicArenaWithWhatItHolds) {
    for (bool const segments : {false, true}) {
        push_to_the_right();
        Scenario scenario = scene({membrane(segments)}, robots_around({500, 500}, 5, 80.0F));
        scenario.boundary = BoundaryCondition::periodic;
        Watch watch(std::move(scenario));
        ASSERT_EQ(watch.inside_at_first(), 5U);
        bool was_left = false;
        bool came_back = false;
        for (int i = 0; i < 150; ++i) {
            watch.run_for(0.1);
            float const x = centroid(line_of(watch.world(), watch.world().membranes[0])).x;
            EXPECT_GT(x, -1.0F);
            EXPECT_LT(x, 1001.0F);
            was_left = was_left || x > 900.0F;
            came_back = came_back || (was_left && x < 100.0F);
        }
        EXPECT_TRUE(came_back);
        expect_kept_area(watch);
    }
}

}  // namespace
}  // namespace pogosim
