// Tests that hold for every physics engine: TEST_P of a suite derived from EachEngine, with make_engine().
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/worker_pool.hpp"
#include "physics/physics_engine.hpp"

namespace pogosim::testing {

/// The engine of the running test.
inline std::string engine_name = "box2d";

/// For all tests.
inline WorkerPool& one_worker() {
    static WorkerPool pool(1);
    return pool;
}

inline std::unique_ptr<PhysicsEngine> make_engine(World const& world, WallSpec const& walls) {
    return make_physics_engine(engine_name, world, walls, one_worker());
}

class EachEngine : public ::testing::TestWithParam<std::string> {
protected:
    void SetUp() override { engine_name = GetParam(); }
};

/// Runs the tests of a suite, a class derived from EachEngine, with each engine.
#define POGOSIM_FOR_EACH_ENGINE(suite)                                           \
    INSTANTIATE_TEST_SUITE_P(Physics, suite, ::testing::Values("box2d", "disk"), \
                             [](::testing::TestParamInfo<std::string> const& info) { return info.param; })

}  // namespace pogosim::testing
