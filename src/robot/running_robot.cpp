#include "robot/context.hpp"

#include <algorithm>

#include "process/backtrace.hpp"
#include "robot/controllers.hpp"

namespace pogosim {

namespace {

void append_tick_and_time(PlaceText& text) {
    if (has_ticks(context.phase)) {
        text << ", tick ";
        text.whole(pogobot_ticks);
    }
    text << ", t = ";
    text.number(context.world->time_s(), 4) << " s";
}

struct ThreadOfRobots {
    Context const* its_context = &context;
    std::uint32_t const* ticks = &pogobot_ticks;
};
thread_local ThreadOfRobots this_thread;

class CodeOfRobots : public RunningCode {
public:
    bool is_known() const override { return context.world != nullptr; }

    PlaceText stage() const override {
        PlaceText text;
        text << name_of(context.phase);
        append_tick_and_time(text);
        return text;
    }

    PlaceText place() const override {
        PlaceText text;
        text << name_of(context.phase);
        if (!context.is_system) {
            text << " of robot #";
            text.whole(context.world->robots.id[context.robot])
                << " of category '" << get_current_robot_category() << "'";
        }
        append_tick_and_time(text);
        return text;
    }

    SignalText<256> how_to_repeat() const override {
        SignalText<256> text;
        World const& world = *context.world;
        double const time_before_s = std::max(0.0, static_cast<double>(world.step) - 0.5) * world.time_step_s;
        text << "run it again with -s ";
        text.whole(context.services->seed) << " --set simulation_time=";
        text.number(time_before_s, 6);
        return text;
    }

    /// A program for the SDK alone has its endless loop where the robot starts, which pogobot.h makes possible.
    bool is_at_start() const override {
        return context.phase == Phase::user_init || (context.phase == Phase::main && context.waiting == Waiting::never);
    }

    void const* of_this_thread() const override { return &this_thread; }

    std::string place_of(void const* thread, void const* code, std::function<bool()> const& is_there) const override {
        auto const& other = *static_cast<ThreadOfRobots const*>(thread);
        RunningRobot const robot{.its_context = *other.its_context, .ticks = *other.ticks};
        if (!is_there() || robot.its_context.world == nullptr) {
            return "";
        }
        RunningRobot const own = running_robot();
        set_running_robot(robot);
        std::string const source = place_in_source(context.services->controllers->image(), code);
        std::string const text = place().c_str() + (source.empty() ? "" : ", " + source);
        set_running_robot(own);
        return text;
    }
};

}  // namespace

RunningCode const& code_of_robots() {
    static CodeOfRobots const code;
    return code;
}

}  // namespace pogosim
