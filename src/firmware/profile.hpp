// Where the cycles of robots go: every instruction is executed alone, and counted for its line and its call path.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "brain/brain.hpp"
#include "firmware/code_places.hpp"
#include "firmware/observer.hpp"

namespace pogosim {

class Profile final : public FirmwareObserver {
public:
    /// Observes the first `robots` robots that run firmware, all with the one of the first. Throws OutputError if the
    /// file cannot be written.
    Profile(std::string file, std::uint32_t robots);

    /// A category runs this firmware.
    void add(World const& world, std::uint32_t category, std::shared_ptr<FirmwareProgram const> const& program);

    bool observes(std::uint32_t robot) const override;
    void note_start(std::uint32_t robot) override;
    Stop run(std::uint32_t robot, Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles,
             double clock_us) override;
    void note_tick(std::uint32_t robot, std::uint32_t ticks, int loop_hz, double clock_us) override;
    void note_call(std::uint32_t robot, std::uint32_t address, double time_us) override;

    /// Throws ConfigError if no robot runs firmware.
    void check() const;

    /// Writes it as JSON, see python/pogosim/firmware/profile/raw.py. A tick in which the run has ended counts if it
    /// has taken longer than it may. Throws OutputError.
    void write();

private:
    struct Cost {
        std::uint64_t cycles = 0;
        double call_us = 0.0;
        std::uint64_t calls = 0;  // of a line: instructions

        void add(Cost const& more) {
            cycles += more.cycles;
            call_us += more.call_us;
            calls += more.calls;
        }
    };

    /// A call path: a function, and the path to it.
    struct Path {
        std::uint32_t parent = 0;  // of the first one: itself
        std::uint32_t function = 0;
        Cost cost{};
    };

    struct Line {
        std::uint32_t function = 0;  // the innermost one
        std::uint32_t line = 0;      // of CodePlaces
        Cost cost{};
    };

    struct Frame {
        std::uint32_t caller_path = 0;  // the path of the instruction that called it
        std::uint32_t returns_to = 0;   // address
        std::size_t span = 0;           // 1 + its index; 0: none is recorded
    };

    struct Tick {
        std::uint32_t robot;
        std::uint32_t number;
        double begin_us;
        std::uint64_t cycles = 0;
        std::uint64_t miss_cycles = 0;  // of those, waiting for code that is not in the instruction cache
        double call_us = 0.0;
    };

    struct Span {
        std::uint32_t robot;
        std::uint32_t function;
        double begin_us;
        double duration_us = 0.0;
        std::size_t depth;
    };

    struct Robot {
        std::uint32_t index;  // in World::robots
        std::uint32_t id;
        std::string category;
        std::vector<Frame> frames{};
        std::uint32_t path = 0;        // of its last instruction
        std::uint32_t chain = 0;       // of that, and
        std::uint32_t chain_path = 0;  // of the frame that it was in
        std::uint32_t lowest_stack = ~0U;
        std::uint32_t highest_heap = 0;
        int ticks_begun = 0;
        bool is_in_library = false;  // it has called a function of it, or is about to
        Tick tick{};
        // Costs in this tick, by path and by line, which count when it has ended.
        std::vector<Cost> path_costs{};
        std::vector<std::uint32_t> used_paths{};
        std::vector<Cost> line_costs{};
        std::vector<std::uint32_t> used_lines{};
    };

    Robot& robot_of(std::uint32_t robot);
    std::uint32_t child(std::uint32_t parent, std::uint32_t function);
    std::uint32_t path_at(Robot& self, std::uint32_t address);
    std::uint32_t line_at(std::uint32_t address);
    static Cost& cost_of(std::uint32_t number, std::vector<Cost>& costs, std::vector<std::uint32_t>& used);
    void end_tick(Robot& self);
    void note_jump(Robot& self, Step const& step, std::uint32_t from, std::uint32_t to, double now_us);
    void note_tail_call(Robot& self, Step const& step, std::uint32_t from, std::uint32_t to);
    void note_memory(Robot& self, Step const& step, Core const& core) const;
    void end_span(Frame const& frame, double now_us);

    std::string file_;
    std::uint32_t most_robots_;
    std::shared_ptr<FirmwareProgram const> program_;
    std::unique_ptr<CodePlaces> places_;
    ProcessorSpec processor_;
    std::vector<Robot> robots_;
    std::vector<Path> paths_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> children_;  // of a path, by function
    std::vector<Line> lines_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> number_of_line_;  // by function and line
    std::vector<std::uint32_t> line_of_word_;  // 1 + its number, of each word of code; 0: not looked up yet
    std::vector<Tick> ticks_;
    std::vector<Span> spans_;
    int loop_hz_ = 0;
};

}  // namespace pogosim
