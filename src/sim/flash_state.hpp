// `flash_state`: robots get their flash memory from an archive before the program starts, and an archive gets it when
// the run has ended well.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/locked_file.hpp"
#include "config/scenario.hpp"
#include "sim/flash_archive.hpp"
#include "world/world.hpp"

namespace pogosim {

using RobotsByOwner = std::map<FlashOwner, std::uint32_t>;  // index in World::robots

class FlashState {
public:
    /// Restores what robots keep while they are off, as the input archive has it, and reserves the output file: no
    /// other run can write it until this object is gone. Until save(), an output file keeps its bytes; a new one is an
    /// archive without records, removed again if nothing is saved. Throws ConfigError for an archive that does not fit
    /// the robots and for an output file that is something else, OutputError for a file that cannot be written. Does
    /// nothing if no file is named.
    FlashState(Scenario const& scenario, World& world);

    /// Writes the output archive, at once as a whole: the records of the input in its order, with those of robots of
    /// this run as they are now; without an input, or with one that has no records, robots sorted by category and id.
    /// Throws OutputError; the file is then as before.
    void save(World const& world);

    /// For the message of a run that does not save: ". The archive 'x' is as before". Empty if there is no output.
    std::string note() const;

    /// Other runs may write the output file.
    void release() { output_ = {}; }

private:
    void reserve_output();

    FlashStateConfig files_;
    RobotsByOwner robots_;
    std::ifstream input_;            // open until the end: the archive may be replaced during the run
    std::size_t input_records_ = 0;  // 0: the order is that of the robots
    LockedFile output_;
};

/// Throws ConfigError if the output file is there, and neither empty nor an archive: the run would replace it.
void check_flash_output(Scenario const& scenario);

/// Whether an input archive is named from which no robot gets anything: it has no records, or is not there and need not
/// be.
bool starts_blank(Scenario const& scenario);

/// Says so, since a misspelt name looks the same. Not of an archive that is the output, too: a first run fills it.
void warn_of_blank_start(Scenario const& scenario);

/// Looks at the input archive without any robots. Throws ConfigError if it has to exist and does not, or is damaged.
void check_flash_input(Scenario const& scenario);

}  // namespace pogosim
