// Variables of a firmware by name, from its debug information: values in robots' memories for the data file and for
// display.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/firmware_program.hpp"
#include "process/program_variables.hpp"
#include "process/variable_text.hpp"
#include "riscv/memory_image.hpp"
#include "world/data_table.hpp"

namespace pogosim {

/// A number or a text at an address.
struct FirmwareVariable {
    std::uint32_t address = 0;
    VariableTypePointer type;
};

class FirmwareVariables {
public:
    explicit FirmwareVariables(FirmwareProgram const& program);

    /// The variable of a name such as "opinion", "mydata.age" or "neighbours[0].id". Throws ConfigError, which begins
    /// with the file and names the nearest variable, if there is none, or if it is neither a number nor a text.
    FirmwareVariable find(std::string const& name) const;

    /// All of them with their values in a robot's memory.
    NamedTexts texts(Memory const& memory) const;

private:
    [[noreturn]] void fail(std::string const& what) const;

    std::string file_;
    ProgramVariables variables_;
};

/// The type of column that has room for a variable's values.
ColumnType column_type_of(VariableType const& type);

/// Its value in a robot's memory.
CellValue value_of(FirmwareVariable const& variable, Memory const& memory);

}  // namespace pogosim
