#include "robot/program_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "base/counted.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "process/sanitizer_functions.hpp"
#include "robot/call_checks.hpp"

namespace pogosim {

namespace {

/// For each category, whether it has robots and the condition holds for all of them.
template <class Test>
std::vector<bool> categories_where_all(World const& world, Test const& is_so) {
    std::vector<std::size_t> robots(world.categories.size());
    std::vector<std::size_t> matching(world.categories.size());
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        std::uint32_t const category = world.robots.category[i];
        ++robots[category];
        matching[category] += is_so(i) ? 1 : 0;
    }
    std::vector<bool> all(world.categories.size());
    for (std::size_t category = 0; category < all.size(); ++category) {
        all[category] = robots[category] > 0 && matching[category] == robots[category];
    }
    return all;
}

bool sends_never(Controller const& controller) {
    return controller.loop.send != nullptr && controller.loop.send_percent == 0 && controller.loop.sent == 0;
}

bool receives_never(Controller const& controller) {
    return controller.loop.receive != nullptr && controller.loop.max_messages_per_tick == 0 &&
           !controller.program.reads_messages;
}

/// "131072 bytes (128 KiB) of a real robot's memory"
std::string memory_text(std::size_t bytes) {
    constexpr double bytes_per_kib = 1024.0;
    return fmt::format("{} bytes ({:.4g} KiB) of a real robot's memory", bytes,
                       static_cast<double>(bytes) / bytes_per_kib);
}

}  // namespace

std::size_t least_memory_bytes(World const& world) {
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (Category const& category : world.categories) {
        bool const has_program = category.spec.robot && needs_program(category.spec.robot->brain);
        least = has_program
                    ? std::min(least, static_cast<std::size_t>(category.spec.robot->model.processor.memory_bytes))
                    : least;
    }
    return least;
}

void warn_of_large_memory(std::string_view what, std::size_t bytes, std::size_t memory_bytes) {
    if (bytes > memory_bytes && __asan_init == nullptr) {
        log().warn("{} {} bytes, more than the {}", what, bytes, memory_text(memory_bytes));
    }
}

void warn_of_large_heap(std::size_t allocated_bytes, std::size_t robots, std::size_t memory_bytes) {
    if (robots > 0 && allocated_bytes / robots > memory_bytes && __asan_init == nullptr) {
        log().warn(
            "each robot has allocated {} bytes in main() and user_init, on average: more than the {}, which "
            "its variables and its stack need, too",
            allocated_bytes / robots, memory_text(memory_bytes));
    }
}

void warn_of_large_stack(std::size_t variables, std::size_t stack, std::size_t memory_bytes) {
    bool const is_told_of_variables = variables > memory_bytes;
    if (variables + stack > memory_bytes && !is_told_of_variables && __asan_init == nullptr) {
        log().warn(
            "the stack of a robot has grown to {} bytes, and its variables have {}: together more than the {}; make "
            "arrays in functions smaller, or calls less deep",
            stack, variables, memory_text(memory_bytes));
    }
}

void warn_of_user_data_in_setup(std::uint32_t id) {
    log().warn("callback_global_setup changed USERDATA (mydata) of robot #{} only: initialise it in user_init", id);
}

void warn_of_idle_categories(World const& world, std::span<Controller const> controllers,
                             std::span<std::string const> started) {
    // A name that another category has is not a typing mistake.
    std::vector<std::string> strange;
    std::ranges::copy_if(started, std::back_inserter(strange), [&world](std::string const& name) {
        return std::ranges::find(world.categories, name, &Category::name) == world.categories.end();
    });
    std::string const calls = started.empty() ? "" : fmt::format(" (only for {})", fmt::join(started, ", "));
    std::vector<bool> warned(world.categories.size());
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        std::uint32_t const category = world.robots.category[i];
        if (needs_program(world.spec_of(i).brain) && !controllers[i].program.registered && !warned[category]) {
            warned[category] = true;
            std::string const& name = world.categories[category].name;
            std::string const meant = did_you_mean(name, strange);
            // Walls, membranes and other things without wheels often have no program.
            if (world.categories[category].spec.robot->model.has_motors() || !meant.empty()) {
                log().warn("the program has no pogobot_start() for category '{}'{}; its robots will do nothing{}", name,
                           calls, meant);
            }
        }
    }
}

void warn_of_missing_init(std::span<Controller const> controllers) {
    auto const runs = [](Controller const& controller) { return controller.program.registered; };
    auto const is_prepared = [](Controller const& controller) { return controller.program.prepared; };
    if (std::ranges::any_of(controllers, runs) && std::ranges::none_of(controllers, is_prepared)) {
        log().warn(
            "the program never calls pogobot_init(), which real robots require: call it at the beginning of main()");
    }
}

void warn_of_empty_columns(std::span<ColumnSpec const> columns, std::span<Controller const> controllers) {
    auto const exports = [](Controller const& controller) { return controller.program.export_data != nullptr; };
    if (!columns.empty() && !controllers.empty() && std::ranges::none_of(controllers, exports)) {
        log().warn(
            "the column '{}'{} of the data file will be empty: the program does not set callback_export_data "
            "(SET_CALLBACK in main())",
            columns.front().name, columns.size() > 1 ? " (like the program's other columns)" : "");
    }
}

void tell_of_unset_columns(DataExport const& data, std::optional<std::vector<std::string>> const& fields) {
    if (data.filled_rows == 0 && !data.awaits_step) {
        return;
    }
    std::vector<std::string> unset;
    for (std::size_t i = 0; i < data.columns.size(); ++i) {
        std::string const& name = data.columns[i].name;
        bool const is_in_file = !fields || std::ranges::find(*fields, name) != fields->end();
        if (!data.was_set[i] && is_in_file) {
            unset.push_back("'" + name + "'");
        }
    }
    if (!unset.empty()) {
        bool const one = unset.size() == 1;
        log().info("the column{} {} of the data file {} empty: {} never set {} ({})", one ? "" : "s",
                   fmt::join(unset, ", "), one ? "is" : "are",
                   data.awaits_step ? "callback_global_step" : "callback_export_data", one ? "it" : "them",
                   data.awaits_step ? "pogosim_world_set_column" : "data_set_value_*");
    }
}

void warn_of_lost_messages(World const& world, std::span<Controller const> controllers) {
    std::vector<std::uint64_t> lost(world.categories.size());
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        if (controllers[i].program.reads_messages || std::holds_alternative<HostSpec>(world.spec_of(i).brain)) {
            lost[world.robots.category[i]] += world.mailboxes.dropped(i);
        }
    }
    for (std::size_t category = 0; category < lost.size(); ++category) {
        if (lost[category] > 0) {
            RobotSpec const& robot = *world.categories[category].spec.robot;
            log().warn(
                "{} to robots of category '{}' {} lost because their queues were full (message_queue_size: {}){}",
                counted(lost[category], "message"), world.categories[category].name,
                lost[category] == 1 ? "was" : "were", robot.ir.queue_size,
                std::holds_alternative<HostSpec>(robot.brain)
                    ? "; the host makes room by clear_received(), once it has read what came"
                    : "");
        }
    }
}

void warn_of_commands(World const& world) {
    std::vector<std::uint64_t> muted(world.categories.size());
    std::vector<std::uint64_t> restarts(world.categories.size());
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        muted[world.robots.category[i]] += world.devices.infrared[i].muted_messages;
        restarts[world.robots.category[i]] += world.devices.infrared[i].restarts;
    }
    for (std::size_t category = 0; category < muted.size(); ++category) {
        std::string const& name = world.categories[category].name;
        if (muted[category] > 0) {
            log().warn("{} of robots of category '{}' {} not sent because they were muted (command DEADCAFE)",
                       counted(muted[category], "message"), name, muted[category] == 1 ? "was" : "were");
        }
        if (restarts[category] > 0) {
            log().warn("{} of robots of category '{}' by the command DEADBEEF", counted(restarts[category], "restart"),
                       name);
        }
    }
}

void warn_of_unused_messages(World const& world, std::span<Controller const> controllers, std::uint64_t arrivals) {
    auto const mute = categories_where_all(world, [&](std::size_t robot) {
        return sends_never(controllers[robot]) && world.devices.messages_sent[robot] == 0;
    });
    auto const deaf =
        categories_where_all(world, [&](std::size_t robot) { return receives_never(controllers[robot]); });
    for (std::size_t category = 0; category < world.categories.size(); ++category) {
        std::string const& name = world.categories[category].name;
        if (mute[category]) {
            log().warn(
                "no robot of category '{}' sent a message: msg_tx_fn is set, but percent_msgs_sent_per_ticks is 0",
                name);
        }
        if (deaf[category]) {
            log().warn(
                "no robot of category '{}' read a message: msg_rx_fn is set, but max_nb_processed_msg_per_tick "
                "is 0",
                name);
        }
    }
    auto const reads = [](Controller const& controller) {
        return controller.program.reads_messages || controller.loop.receive != nullptr;  // at its next tick
    };
    auto const listens = [](Category const& category) {
        return category.spec.robot && !needs_program(category.spec.robot->brain);
    };
    if (std::ranges::any_of(world.categories, listens)) {
        return;  // a host may read what has arrived
    }
    if (arrivals > 0 && std::ranges::none_of(controllers, reads) && std::ranges::none_of(deaf, std::identity())) {
        log().warn(
            "{} arrived, but no robot reads {}: set msg_rx_fn in user_init, or look for messages with "
            "pogobot_infrared_message_available()",
            counted(arrivals, "message"), arrivals == 1 ? "it" : "them");
    }
}

void warn_of_equal_seeds(std::span<Controller const> controllers) {
    std::optional<unsigned> first;
    std::size_t count = 0;
    for (Controller const& controller : controllers) {
        if (std::optional<unsigned> const seed = controller.program.seed) {
            if (count > 0 && seed != first) {
                return;
            }
            first = seed;
            ++count;
        }
    }
    if (count > 1) {
        log().warn(
            "{} robots have called srand({}): with the same seed, they draw the same random numbers. For numbers of "
            "its own, each robot calls srand(pogobot_helper_getRandSeed())",
            count, *first);
    }
}

void warn_of_send_results(std::span<Controller const> controllers) {
    SendResults all;
    for (Controller const& controller : controllers) {
        all.sent += controller.send_results.sent;
        all.said += controller.send_results.said;
    }
    if (all.sent > 0 && all.said == 0) {
        log().warn(
            "msg_tx_fn has sent messages in {} and returned false in each, so nb_msgs_sent is 0: return true "
            "when a message was sent (the send functions return 0 then)",
            counted(all.sent, "call"));
    }
}

void warn_of_undecoded_messages(std::span<Controller const> controllers) {
    auto const reads = [](Controller const& controller) { return controller.program.reads_messages; };
    auto const decodes = [](Controller const& controller) { return controller.program.decodes_messages; };
    if (std::ranges::any_of(controllers, reads) && std::ranges::none_of(controllers, decodes)) {
        log().warn(
            "the program reads messages and never calls pogobot_infrared_update(), without which a real robot receives "
            "none: call it before pogobot_infrared_message_available()");
    }
}

void tell_of_lost_flash_writes(World const& world) {
    struct Lost {
        std::uint64_t writes = 0;
        std::uint64_t robots = 0;
    };
    std::vector<Lost> lost(world.categories.size());
    for (std::size_t robot = 0; robot < world.robots.size(); ++robot) {
        if (std::uint64_t const count = world.devices.flash[robot].lost_writes; count > 0) {
            Lost& of_category = lost[world.robots.category[robot]];
            of_category.writes += count;
            ++of_category.robots;
        }
    }
    for (std::size_t category = 0; category < lost.size(); ++category) {
        if (lost[category].writes > 1) {  // else it was said when it happened
            log().warn("{} of category '{}' wrote pages of flash that were not erased, {} in all (flash: nor)",
                       counted(lost[category].robots, "robot"), world.categories[category].name,
                       counted(lost[category].writes, "write"));
        }
    }
}

void tell_of_ended_programs(std::span<Controller const> controllers) {
    auto const has_returned = [](Controller const& controller) { return controller.program.returned; };
    auto const ended = std::ranges::count_if(controllers, has_returned);
    if (ended > 0) {
        log().info("main() of {} has returned: such a robot keeps its motors and LEDs and does nothing more",
                   counted(ended, "robot"));
    }
}

void note_loop_globals(World const& world, LoopGlobals const& loop, int most_loop_hz) {
    if (loop.send_percent > kMostSendPercent) {
        note_slip({"", "percent_msgs_sent_per_ticks", "0 to 100", "it counts as 100"}, loop.send_percent);
    }
    if (loop.error_led >= static_cast<int>(kLedCount)) {
        note_slip(
            {"", "error_codes_led_idx", "0 (head) to 4 (left), or a negative number for none", "no LED shows errors"},
            loop.error_led);
    }
    if (loop.loop_hz > most_loop_hz) {
        context.services->warn_once(
            "main_loop_hz is {}, but a robot ticks at most once in each time_step of {} s: ticks are skipped; set the "
            "highest value in user_init, which shortens the time_step, or set time_step to {} s",
            loop.loop_hz, world.time_step_s, seconds_between_ticks(loop.loop_hz));
    }
}

}  // namespace pogosim
