#include "riscv/code.hpp"

#include <algorithm>
#include <cassert>

#include "riscv/instruction_cache.hpp"
#include "riscv/memory_image.hpp"

namespace pogosim {

namespace {

/// Cycles of an instruction: of a branch, if it is not taken; of a shift by a register, if it is by one bit.
int least_cycles(Instruction const& instruction, CycleCosts const& costs) {
    using enum Operation;
    switch (instruction.operation) {
        case jal:
            return costs.jump;
        case jalr:
            return costs.jump_register;
        case beq:
        case bne:
        case blt:
        case bge:
        case bltu:
        case bgeu:
            return instruction.immediate < 0 ? costs.branch_mispredicted : costs.branch_predicted_not_taken;
        case lb:
        case lh:
        case lw:
        case lbu:
        case lhu:
            return costs.load;
        case sb:
        case sh:
        case sw:
            return costs.store;
        case slli:
        case srli:
        case srai:
            return costs.shift + costs.shift_further_bit * (std::max(1, instruction.immediate) - 1);
        case sll:
        case srl:
        case sra:
            return costs.shift;
        case mul:
        case mulh:
        case mulhsu:
        case mulhu:
            return costs.multiply;
        case div:
        case divu:
        case rem:
        case remu:
            return costs.divide;
        default:
            return costs.alu;
    }
}

bool is_branch(Operation operation) {
    return operation >= Operation::beq && operation <= Operation::bgeu;
}

bool is_shift_by_register(Operation operation) {
    return operation == Operation::sll || operation == Operation::srl || operation == Operation::sra;
}

/// Whether the steps after this one are not executed directly after it, or the sum of their cycles has changed.
bool ends_sum(Operation operation) {
    return operation == Operation::jal || operation == Operation::jalr || operation == Operation::jump_outside ||
           is_shift_by_register(operation);
}

/// Puts steps in the place of bytes, and addresses in the place of distances.
void place(Step& step, std::uint32_t address, Code const& code) {
    using enum Operation;
    std::uint32_t const target = address + static_cast<std::uint32_t>(step.immediate);
    if (step.operation == auipc) {
        step.operation = lui;
        step.immediate = static_cast<std::int32_t>(target);
    } else if (is_branch(step.operation) || step.operation == jal) {
        if (target % 4 == 0 && target - code.address < code.bytes()) {
            step.immediate /= 4;
        } else {
            step.rd = is_branch(step.operation) ? static_cast<std::uint8_t>(step.operation) : step.rd;
            step.operation = is_branch(step.operation) ? branch_outside : jump_outside;
            step.immediate = static_cast<std::int32_t>(target);
        }
    }
}

/// Sets what leaving the order of steps does to their sum of cycles.
void set_other_cycles(std::uint32_t index, CycleCosts const& costs, Code& code) {
    Step& step = code.steps[index];
    if (step.operation == Operation::jalr) {
        step.other_cycles = costs.jump_register;
    } else if (is_shift_by_register(step.operation)) {
        step.other_cycles = costs.shift_further_bit;
    } else if (step.operation == Operation::jal || is_branch(step.operation)) {
        auto const cycles = static_cast<std::uint32_t>(step.operation == Operation::jal ? costs.jump
                                                       : step.immediate < 0             ? costs.branch_predicted_taken
                                                                                        : costs.branch_mispredicted);
        std::uint32_t const target = index + static_cast<std::uint32_t>(step.immediate);
        step.other_cycles = static_cast<std::int32_t>(code.cycles_before[index] + cycles - code.cycles_before[target]);
    }
}

}  // namespace

Code decode_code(std::uint32_t address, std::span<std::byte const> bytes, CycleCosts const& costs) {
    assert(address % 4 == 0);
    std::size_t const words = bytes.size() / 4;
    Code code{.address = address,
              .steps = std::vector<Step>(words + 1),
              .cycles_before{},
              .cache_miss = static_cast<std::uint32_t>(costs.cache_miss)};
    code.cycles_before.push_back(0);
    for (std::uint32_t i = 0; i < words; ++i) {
        Instruction const read = decode(read_little_endian<4>(&bytes[4 * i]));
        code.steps[i] = {.operation = read.operation,
                         .rd = read.rd == 0 ? kUnread : read.rd,
                         .rs1 = read.rs1,
                         .rs2 = read.rs2,
                         .immediate = read.immediate};
        place(code.steps[i], address + 4 * i, code);
        code.cycles_before.push_back(code.cycles_before.back() + static_cast<std::uint32_t>(least_cycles(read, costs)));
    }
    code.steps.back() = {.operation = Operation::jump_outside,
                         .immediate = static_cast<std::int32_t>(address + code.bytes())};
    std::uint32_t end = 0;
    for (auto i = static_cast<std::uint32_t>(code.steps.size()); i-- > 0;) {
        set_other_cycles(i, costs, code);
        end = ends_sum(code.steps[i].operation) ? i : end;
        std::uint32_t const lines = cache_line(address + 4 * end) - cache_line(address + 4 * i) + 1;
        code.steps[i].cycles_to_end = code.cycles_before[end] + lines * code.cache_miss;
    }
    return code;
}

bool intercept(Code& code, std::uint32_t address, std::int32_t number) {
    if (code.step_at(address) == nullptr) {
        return false;
    }
    std::uint32_t const offset = address - code.address;
    code.steps[offset / 4].operation = Operation::intercepted;
    code.steps[offset / 4].immediate = number;
    return true;
}

std::int32_t intercepted_number(Code const& code, std::uint32_t address) {
    return code.step_at(address)->immediate;
}

}  // namespace pogosim
