// Robots that run the machine code of a program on emulated processors. Functions of the robots' library (Pogolib) are
// intercepted at their symbols and act on the devices, see library_functions(); all other code is executed as it is.
//
// A robot runs while its clock is not ahead of the step. Its code takes no time, or that of its cycles (`cpu_time`). A
// program that sleeps in the main loop has ended its tick: it goes on to the next call of the library at once, so that
// its variables are those between two ticks.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/worker_pool.hpp"
#include "brain/brain.hpp"
#include "firmware/firmware_call.hpp"
#include "firmware/firmware_program.hpp"
#include "firmware/firmware_robot.hpp"
#include "firmware/firmware_variables.hpp"
#include "firmware/observer.hpp"

namespace pogosim {

/// What a run gives to its firmware.
struct FirmwareServices {
    std::uint64_t seed = 0;   // of the run
    double timeout_s = 10.0;  // processor time of a robot after which code that never waits ends the run; 0: none
    WorkerPool* workers = nullptr;
    FirmwareObserver* observer = nullptr;  // null: none looks on; else robots run in one thread
    std::function<void(std::uint32_t robot, std::string_view line)> print;  // a line that a robot has printed
    std::function<bool()> is_interrupted = [] { return false; };            // the user wants the run to end
};

class FirmwareBrain final : public Brain {
public:
    /// Drives the robots of a category, whose brain is a firmware. `world`, and what services point to, outlive this.
    FirmwareBrain(World& world, std::uint32_t category, std::shared_ptr<FirmwareProgram const> program,
                  FirmwareServices services);

    /// Each robot runs until its main loop begins, or it sleeps.
    bool start() override;
    bool run_step() override;
    bool stop() override;
    void declare_columns(std::vector<ColumnSpec>& columns) override;
    void fill_row(std::uint32_t robot, std::span<CellValue> cells) const override;
    NamedTexts texts_of(std::uint32_t robot) const override;
    int highest_loop_hz() const override;
    std::optional<UserFailure> failure() const override { return failure_; }
    void append_state(std::vector<std::byte>& bytes) const override;
    void take_state(std::span<std::byte const>& bytes) override;

    RobotRange robots() const { return range_; }
    std::uint32_t category() const { return category_; }
    std::shared_ptr<FirmwareProgram const> const& program() const { return program_; }
    FirmwareRobot const& robot(std::uint32_t robot) const { return robots_[robot - range_.first]; }

private:
    struct Part {
        FirmwareOutbox out;
        std::optional<UserFailure> failure;
    };

    FirmwareRobot new_robot(std::uint32_t robot) const;
    bool run_all();
    void run_part(WorkRange range);
    void run_robot(std::uint32_t robot, Part& part);
    void go_on(FirmwareCall& call) const;
    bool begin_tick(FirmwareCall& call) const;
    bool make_call(FirmwareCall& call, LibraryFunction const& function) const;
    bool note_call(FirmwareCall& call, LibraryFunction const& function) const;
    void restart(std::uint32_t robot);
    void warn_of_endless_ticks() const;
    std::uint64_t budget(FirmwareCall const& call, std::uint64_t used) const;
    std::uint64_t cycle_limit() const;
    void check_time(FirmwareCall const& call, std::uint64_t used) const;
    Stop run_core(FirmwareCall& call, std::uint64_t most_cycles) const;
    bool is_observed(std::uint32_t robot) const;
    void check_stack(FirmwareCall& call) const;
    void count_time(FirmwareCall& call) const;
    bool is_ahead(FirmwareCall const& call) const;
    void join(Part& part);
    FirmwareVariables const& variables() const;
    std::string load_text(FirmwareRobot const& self) const;
    int loop_hz_of(FirmwareRobot const& self) const;
    std::optional<int> written_loop_hz(FirmwareRobot const& self) const;
    bool is_counted() const { return spec_.cpu_time == CpuTime::counted; }
    std::string place_of(FirmwareRobot const& self) const;
    UserFailure failure_of(FirmwareCall const& call, std::string what) const;

    World& world_;
    std::uint32_t category_;
    RobotRange range_;
    RobotSpec const& spec_;
    std::shared_ptr<FirmwareProgram const> program_;
    FirmwareServices services_;
    std::vector<FirmwareRobot> robots_;
    std::vector<Part> parts_;
    std::vector<Slip> warned_;
    struct Column {
        std::size_t index;  // in the data file's columns of the user
        FirmwareVariable variable;
    };
    std::vector<Column> columns_;
    mutable std::optional<FirmwareVariables> variables_;  // from the first look at them on
    std::int64_t step_us_ = 0;                            // time of the step
    std::optional<UserFailure> failure_;
};

}  // namespace pogosim
