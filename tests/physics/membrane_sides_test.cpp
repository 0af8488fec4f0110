// What the engine lets through a soft membrane comes back.
#include "physics/membrane_sides.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

/// A robot in the middle of a membrane of 4 or more disks, another one outside, moved by hand.
class MembraneOfDisks : public ::testing::Test {
protected:
    void make(int count, float radius_mm, float spring_mm = 0.0F) {
        membrane_.body_count = static_cast<std::uint32_t>(count);
        for (int i = 0; i < count; ++i) {
            ObjectSpec spec = testing::pogobot_spec();
            spec.shape.radius_mm = radius_mm;
            testing::add_robot(
                world_, centre_mm_ + 100.0F * direction(6.2831853F * static_cast<float>(i) / static_cast<float>(count)),
                0.0F, spec);
        }
        if (spring_mm > 0.0F) {
            Joint& joint = world_.joints.emplace_back();
            joint.b = 1;
            joint.length_mm = spring_mm;
            joint.max_stretch = 0.05F;
        }
        inside_ = testing::add_robot(world_, centre_mm_);
        outside_ = testing::add_robot(world_, {900, 500});
        world_.membranes.push_back(membrane_);
        bodies().velocity_mm_s.assign(bodies().size(), {1.0F, 2.0F});
        sides_.emplace(world_);
    }

    Bodies& bodies() { return world_.bodies; }
    void move(std::uint32_t body, Vec2 to_mm) {
        Vec2 const velocity_mm_s = bodies().velocity_mm_s[body];
        set_pose(bodies(), body, to_mm, 0.5F);
        bodies().velocity_mm_s[body] = velocity_mm_s;
    }
    Vec2 place(std::uint32_t body) const { return world_.bodies.position_mm[body]; }
    bool holds() { return !sides_->hold(world_).empty(); }

    Vec2 centre_mm_{500, 500};
    Membrane membrane_;
    World world_ = testing::square_world();
    std::uint32_t inside_ = 0;
    std::uint32_t outside_ = 0;
    std::optional<MembraneSides> sides_;
};

TEST_F(MembraneOfDisks, LeavesBodiesAloneThatStayOnTheirSide) {
    make(12, 10.0F);
    move(inside_, {550, 520});
    move(outside_, {620, 500});
    EXPECT_FALSE(holds());
    EXPECT_EQ(place(inside_), (Vec2{550, 520}));
    EXPECT_EQ(place(outside_), (Vec2{620, 500}));
    EXPECT_EQ(bodies().velocity_mm_s[inside_].y, 2.0F);
}

TEST_F(MembraneOfDisks, PutsBackAtRestWhoeverJumpsOutOrIn) {
    make(12, 10.0F);
    move(inside_, {560, 500});
    move(outside_, {700, 500});
    ASSERT_FALSE(holds());
    move(inside_, {650, 500});
    move(outside_, {690, 500});
    EXPECT_TRUE(holds());
    EXPECT_EQ(place(inside_), (Vec2{560, 500}));
    EXPECT_EQ(bodies().velocity_mm_s[inside_], Vec2{});
    // The other one goes on.
    EXPECT_EQ(place(outside_), (Vec2{690, 500}));
    EXPECT_EQ(bodies().velocity_mm_s[outside_].y, 2.0F);

    move(outside_, {520, 500});
    EXPECT_TRUE(holds());
    EXPECT_EQ(place(outside_), (Vec2{690, 500}));
}

TEST_F(MembraneOfDisks, ComesBackWhenItMovedOverABodyAndOthersGoOn) {
    make(12, 10.0F);
    std::vector<Vec2> const before_mm = bodies().position_mm;
    for (std::uint32_t i = 0; i < membrane_.body_count; ++i) {
        move(i, place(i) + Vec2{200, 0});
    }
    move(inside_, {505, 500});
    move(outside_, {910, 500});
    EXPECT_TRUE(holds());
    for (std::uint32_t i = 0; i < bodies().size(); ++i) {
        if (i != outside_) {
            EXPECT_EQ(place(i), before_mm[i]);
            EXPECT_EQ(bodies().heading_rad[i], 0.0F);
            EXPECT_EQ(bodies().heading_dir[i], (Vec2{1.0F, 0.0F}));
            EXPECT_EQ(bodies().velocity_mm_s[i], Vec2{});
        }
    }
    EXPECT_EQ(place(outside_), (Vec2{910, 500}));
    EXPECT_EQ(bodies().velocity_mm_s[outside_].y, 2.0F);
}

TEST_F(MembraneOfDisks, ThatComesBackOverAnotherBodyPutsItBackToo) {
    make(12, 10.0F);
    // The membrane leaves one behind, and another one enters where it was.
    for (std::uint32_t i = 0; i < membrane_.body_count; ++i) {
        move(i, place(i) + Vec2{-200, 0});
    }
    move(outside_, {560, 500});
    EXPECT_TRUE(holds());
    EXPECT_EQ(place(inside_), centre_mm_);
    EXPECT_EQ(place(outside_), (Vec2{900, 500}));
    EXPECT_EQ(place(0), (Vec2{600, 500}));
}

TEST_F(MembraneOfDisks, LetsThroughWhatFitsBetweenItsDisks) {
    make(6, 10.0F, /*spring_mm=*/80.0F);  // 64 mm remain when it is stretched
    move(inside_, {700, 500});
    EXPECT_FALSE(holds());
    EXPECT_EQ(place(inside_), (Vec2{700, 500}));
}

TEST_F(MembraneOfDisks, StopsWhatDoesNotFitBetweenItsDisks) {
    make(6, 10.0F, /*spring_mm=*/65.0F);  // 48 mm
    move(inside_, {700, 500});
    EXPECT_TRUE(holds());
    EXPECT_EQ(place(inside_), centre_mm_);
}

}  // namespace
}  // namespace pogosim
