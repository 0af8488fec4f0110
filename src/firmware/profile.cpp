#include "firmware/profile.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/escaped.hpp"

namespace pogosim {

namespace {

constexpr std::uint8_t kReturnAddress = 1;  // register ra
constexpr std::uint8_t kMillicode = 5;      // register t0, with which the compiler calls its own helpers
constexpr std::size_t kStackPointer = 2;
constexpr int kTicksWithSpans = 3;
constexpr std::size_t kMostSpans = 20'000;
constexpr std::size_t kMostFrames = 4'000;  // deeper calls count for their callers

bool is_store(Operation operation) {
    return operation == Operation::sb || operation == Operation::sh || operation == Operation::sw;
}

/// The elements of a list, each as text_of() says, on lines of their own.
template <class List, class Text>
std::string json_list(List const& list, Text const& text_of) {
    std::string result = "[";
    for (auto const& element : list) {
        result += (result.size() > 1 ? ",\n  " : "\n  ") + text_of(element);
    }
    return result + "]";
}

}  // namespace

Profile::Profile(std::string file, std::uint32_t robots) : file_(std::move(file)), most_robots_(robots) {
    std::error_code ignored;
    if (std::filesystem::is_fifo(file_, ignored)) {
        throw OutputError(fmt::format("cannot write the profile {}: it is a pipe; give a file", escaped(file_)));
    }
    if (!std::ofstream(file_, std::ios::binary | std::ios::app)) {  // before a run that would be in vain
        throw OutputError(fmt::format("cannot write the profile {}", escaped(file_)));
    }
    if (std::filesystem::is_regular_file(file_, ignored) && std::filesystem::file_size(file_, ignored) == 0) {
        std::filesystem::remove(file_, ignored);
    }
}

void Profile::add(World const& world, std::uint32_t category, std::shared_ptr<FirmwareProgram const> const& program) {
    if (program_ && program_ != program) {
        return;
    }
    RobotRange const range = robots_of(world, category);
    for (std::uint32_t robot = range.first; robot < range.last && robots_.size() < most_robots_; ++robot) {
        robots_.push_back({.index = robot, .id = world.robots.id[robot], .category = world.categories[category].name});
    }
    if (!program_ && !robots_.empty()) {
        program_ = program;
        places_ = std::make_unique<CodePlaces>(*program);
        processor_ = world.categories[category].spec.robot->model.processor;
        paths_.push_back({});
        line_of_word_.resize(program->firmware.code.bytes() / 4);
    }
}

bool Profile::observes(std::uint32_t robot) const {
    return std::ranges::find(robots_, robot, &Robot::index) != robots_.end();
}

/// The calls of before are gone, and the tick in which the robot was does not count.
void Profile::note_start(std::uint32_t robot) {
    Robot& self = robot_of(robot);
    self = {.index = self.index,
            .id = self.id,
            .category = std::move(self.category),
            .lowest_stack = self.lowest_stack,
            .highest_heap = self.highest_heap};
}

Profile::Robot& Profile::robot_of(std::uint32_t robot) {
    return *std::ranges::find(robots_, robot, &Robot::index);
}

std::uint32_t Profile::child(std::uint32_t parent, std::uint32_t function) {
    auto const number = static_cast<std::uint32_t>(paths_.size());
    auto const [found, is_new] = children_.try_emplace({parent, function}, number);
    if (is_new) {
        paths_.push_back({.parent = parent, .function = function});
    }
    return found->second;
}

/// The path of the instruction at an address: what has called its function, then that, then what is inlined there.
std::uint32_t Profile::path_at(Robot& self, std::uint32_t address) {
    std::uint32_t const base = self.frames.empty() ? 0 : self.frames.back().caller_path;
    std::uint32_t const chain = places_->chain_of(address);
    if (self.path == 0 || chain != self.chain || base != self.chain_path) {
        self.chain = chain;
        self.chain_path = base;
        self.path = base;
        for (std::uint32_t const function : places_->chain(chain)) {
            self.path = child(self.path, function);
        }
    }
    return self.path;
}

std::uint32_t Profile::line_at(std::uint32_t address) {
    std::uint32_t& known = line_of_word_[places_->word_of(address)];
    if (known == 0) {
        std::uint32_t const function = places_->chain(places_->chain_of(address)).back();
        auto const number = static_cast<std::uint32_t>(lines_.size());
        auto const [found, is_new] = number_of_line_.try_emplace({function, places_->line_of(address)}, number);
        if (is_new) {
            lines_.push_back({.function = function, .line = places_->line_of(address)});
        }
        known = found->second + 1;
    }
    return known - 1;
}

/// The cost of a path or line in the tick of a robot, which is noted as used.
Profile::Cost& Profile::cost_of(std::uint32_t number, std::vector<Cost>& costs, std::vector<std::uint32_t>& used) {
    if (costs.size() <= number) {
        costs.resize(std::size_t{number} + 1);
    }
    Cost& cost = costs[number];
    if (cost.cycles == 0 && cost.calls == 0 && cost.call_us == 0.0) {
        used.push_back(number);
    }
    return cost;
}

/// Adds the costs of a tick to those of all ticks.
void Profile::end_tick(Robot& self) {
    ticks_.push_back(self.tick);
    auto const count = [](auto& totals, std::vector<Cost>& costs, std::vector<std::uint32_t>& used) {
        for (std::uint32_t const number : used) {
            totals[number].cost.add(costs[number]);
            costs[number] = {};
        }
        used.clear();
    };
    count(paths_, self.path_costs, self.used_paths);
    count(lines_, self.line_costs, self.used_lines);
}

Stop Profile::run(std::uint32_t robot, Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles,
                  double clock_us) {
    Robot& self = robot_of(robot);
    std::uint64_t const begin = core.cycles;
    bool const was_in_library = std::exchange(self.is_in_library, false);
    if (was_in_library && !self.frames.empty() && self.frames.back().returns_to == core.pc) {
        end_span(self.frames.back(), clock_us);
        self.frames.pop_back();
    }
    while (core.cycles - begin < most_cycles) {
        std::uint32_t const from = core.pc;
        std::uint64_t const before = core.cycles;
        std::uint64_t const misses_before = core.cache.misses;
        Stop const stop = pogosim::run(core, memory, code, 1);
        std::uint64_t const cycles = core.cycles - before;
        if (cycles == 0) {
            self.is_in_library = stop.reason == StopReason::intercepted;
            return stop;
        }
        Step const& step = *code.step_at(from);
        if (self.ticks_begun > 0) {
            cost_of(path_at(self, from), self.path_costs, self.used_paths).cycles += cycles;
            cost_of(line_at(from), self.line_costs, self.used_lines).add({.cycles = cycles, .calls = 1});
            self.tick.cycles += cycles;
            self.tick.miss_cycles += code.cache_miss * (core.cache.misses - misses_before);
        }
        note_memory(self, step, core);
        if (core.pc != from + 4) {
            double const now_us = clock_us + processor_.us_of(static_cast<double>(core.cycles - begin));
            note_jump(self, step, from, core.pc, now_us);
        }
    }
    return {StopReason::budget_used, core.pc, 0};
}

/// A call goes on in another frame, and ends with a jump to where it returns to.
void Profile::note_jump(Robot& self, Step const& step, std::uint32_t from, std::uint32_t to, double now_us) {
    bool const is_call = (step.operation == Operation::jal || step.operation == Operation::jalr) &&
                         (step.rd == kReturnAddress || step.rd == kMillicode);
    if (is_call && self.frames.size() < kMostFrames) {
        Frame frame{.caller_path = path_at(self, from), .returns_to = from + 4};
        if (self.ticks_begun > 0 && self.ticks_begun <= kTicksWithSpans && spans_.size() < kMostSpans) {
            spans_.push_back({.robot = self.index,
                              .function = places_->function_of(to),
                              .begin_us = now_us,
                              .depth = self.frames.size()});
            frame.span = spans_.size();
        }
        self.frames.push_back(frame);
        if (self.ticks_begun > 0) {
            ++cost_of(path_at(self, to), self.path_costs, self.used_paths).calls;
        }
        return;
    }
    bool const is_return = step.operation == Operation::jalr && step.rd == kUnread &&
                           (step.rs1 == kReturnAddress || step.rs1 == kMillicode);
    if (!is_return) {
        note_tail_call(self, step, from, to);
        return;
    }
    auto const returned = std::find_if(self.frames.rbegin(), self.frames.rend(),
                                       [to](Frame const& frame) { return frame.returns_to == to; });
    if (returned != self.frames.rend()) {
        for (std::ptrdiff_t left = returned - self.frames.rbegin() + 1; left > 0; --left) {
            end_span(self.frames.back(), now_us);
            self.frames.pop_back();
        }
    }
}

/// A jump to another function is a call that does not come back: that one returns to this one's caller. In a path, a
/// function stands once among those that have called each other so.
void Profile::note_tail_call(Robot& self, Step const& step, std::uint32_t from, std::uint32_t to) {
    bool const jumps = (step.operation == Operation::jal || step.operation == Operation::jalr) && step.rd == kUnread;
    if (!jumps || self.frames.empty() || !places_->is_entry(to) ||
        places_->function_of(to) == places_->function_of(from)) {
        return;
    }
    std::uint32_t& base = self.frames.back().caller_path;
    std::uint32_t const from_path = path_at(self, from);
    std::uint32_t caller = from_path;
    for (std::uint32_t path = from_path; path != base && path != 0; path = paths_[path].parent) {
        caller = paths_[path].function == places_->function_of(to) ? paths_[path].parent : caller;
    }
    base = caller;
    if (self.ticks_begun > 0) {
        ++cost_of(path_at(self, to), self.path_costs, self.used_paths).calls;
    }
}

void Profile::end_span(Frame const& frame, double now_us) {
    if (frame.span > 0) {
        spans_[frame.span - 1].duration_us = now_us - spans_[frame.span - 1].begin_us;
    }
}

/// The stack grows downwards. What is written between the variables and the stack is on the heap.
void Profile::note_memory(Robot& self, Step const& step, Core const& core) const {
    std::uint32_t const stack = core.x[kStackPointer];
    std::uint32_t const end = program_->firmware.variables_end;
    if (stack >= end) {
        self.lowest_stack = std::min(self.lowest_stack, stack);
    }
    if (is_store(step.operation)) {
        std::uint32_t const address = core.x[step.rs1] + static_cast<std::uint32_t>(step.immediate);
        if (address >= end && address < self.lowest_stack) {
            self.highest_heap = std::max(self.highest_heap, address + 1);
        }
    }
}

void Profile::note_tick(std::uint32_t robot, std::uint32_t ticks, int loop_hz, double clock_us) {
    Robot& self = robot_of(robot);
    loop_hz_ = loop_hz;
    if (self.ticks_begun++ > 0) {
        end_tick(self);
    }
    self.tick = {.robot = robot, .number = ticks, .begin_us = clock_us};
}

void Profile::note_call(std::uint32_t robot, std::uint32_t address, double time_us) {
    Robot& self = robot_of(robot);
    if (self.ticks_begun > 0) {
        cost_of(path_at(self, address), self.path_costs, self.used_paths).call_us += time_us;
        self.tick.call_us += time_us;
    }
}

void Profile::check() const {
    if (!program_) {
        throw ConfigError("--profile: no robot of the configuration runs firmware; name one with --firmware FILE");
    }
}

void Profile::write() {
    constexpr double us_per_s = 1e6;
    // The tick in which the run ends counts if it has already taken too long.
    for (Robot& robot : robots_) {
        double const taken_us = processor_.us_of(static_cast<double>(robot.tick.cycles)) + robot.tick.call_us;
        if (robot.ticks_begun > 0 && loop_hz_ > 0 && taken_us > us_per_s / loop_hz_) {
            end_tick(robot);
        }
    }
    auto const frames_of = [this](std::uint32_t path) {
        std::vector<std::uint32_t> frames;
        for (; path != 0; path = paths_[path].parent) {
            frames.push_back(paths_[path].function);
        }
        std::ranges::reverse(frames);
        return fmt::format("{}", fmt::join(frames, ", "));
    };
    std::vector<std::uint32_t> used;
    for (std::uint32_t path = 1; path < paths_.size(); ++path) {
        Cost const& cost = paths_[path].cost;
        if (cost.cycles > 0 || cost.call_us > 0.0 || cost.calls > 0) {
            used.push_back(path);
        }
    }
    MemoryImage const& image = *program_->firmware.image;
    auto const memory_end = static_cast<std::uint32_t>(image.address + image.bytes.size());
    std::uint32_t const end = program_->firmware.variables_end;
    std::uint32_t deepest = 0;
    std::uint32_t heap = 0;
    for (Robot const& robot : robots_) {
        deepest = std::max(deepest, robot.lowest_stack > memory_end ? 0 : memory_end - robot.lowest_stack);
        heap = std::max(heap, robot.highest_heap > end ? robot.highest_heap - end : 0);
    }
    std::ofstream out(file_, std::ios::binary);
    out << fmt::format(
        "{{\"version\": 1,\n\"firmware\": {},\n\"clock_hz\": {}, \"cycle_factor\": {}, \"loop_hz\": {},\n"
        "\"memory_bytes\": {}, \"program_bytes\": {}, \"variable_bytes\": {},\n"
        "\"deepest_stack_bytes\": {}, \"heap_bytes\": {},\n",
        json_text(escaped(program_->file)), processor_.clock_hz, processor_.cycle_factor, loop_hz_,
        processor_.memory_bytes, program_->firmware.program_bytes, program_->firmware.variable_bytes, deepest, heap);
    out << "\"robots\": "
        << json_list(robots_,
                     [](Robot const& robot) {
                         return fmt::format("{{\"id\": {}, \"category\": {}}}", robot.id, json_text(robot.category));
                     })
        << ",\n\"ticks\": "
        << json_list(ticks_,
                     [this](Tick const& tick) {
                         return fmt::format(
                             "{{\"robot\": {}, \"tick\": {}, \"begin_s\": {:.6f}, \"cycles\": {}, \"miss_cycles\": {}, "
                             "\"call_us\": {:.3f}}}",
                             robot_of(tick.robot).id, tick.number, tick.begin_us * 1e-6, tick.cycles, tick.miss_cycles,
                             tick.call_us);
                     })
        << ",\n\"functions\": "
        << json_list(places_->functions(), [](std::string const& name) { return json_text(escaped(name)); })
        << ",\n\"lines\": "
        << json_list(lines_,
                     [this](Line const& entry) {
                         CodePlaces::Line const& line = places_->line(entry.line);
                         return fmt::format(
                             "{{\"function\": {}, \"file\": {}, \"line\": {}, \"cycles\": {}, \"instructions\": {}}}",
                             entry.function, json_text(escaped(line.file)), line.number, entry.cost.cycles,
                             entry.cost.calls);
                     })
        << ",\n\"stacks\": "
        << json_list(used,
                     [&](std::uint32_t number) {
                         Path const& path = paths_[number];
                         return fmt::format("{{\"frames\": [{}], \"cycles\": {}, \"call_us\": {:.3f}, \"calls\": {}}}",
                                            frames_of(number), path.cost.cycles, path.cost.call_us, path.cost.calls);
                     })
        << ",\n\"spans\": "
        << json_list(
               spans_,
               [this](Span const& span) {
                   return fmt::format(
                       "{{\"robot\": {}, \"name\": {}, \"begin_us\": {:.3f}, \"duration_us\": {:.3f}, \"depth\": {}}}",
                       robot_of(span.robot).id, span.function, span.begin_us, span.duration_us, span.depth);
               })
        << "}\n";
    out.close();
    if (!out) {
        throw OutputError(fmt::format("cannot write the profile {}", escaped(file_)));
    }
}

}  // namespace pogosim
