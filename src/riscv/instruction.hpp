// One instruction of the robots' processor: RV32I with multiplication and division (RV32IM).
//
// Source: The RISC-V Instruction Set Manual, Volume I: Unprivileged ISA, version 20191213: chapter 2 (RV32I), chapter 7
// ("M"), and the tables of chapter 24.
#pragma once

#include <cstdint>

namespace pogosim {

/// Named as in the manual. An underscore follows names that C++ has taken.
enum class Operation : std::uint8_t {
    illegal,  // nothing that this processor has: compressed, atomic, floating-point, mret
    lui,
    auipc,
    jal,
    jalr,
    beq,
    bne,
    blt,
    bge,
    bltu,
    bgeu,
    lb,
    lh,
    lw,
    lbu,
    lhu,
    sb,
    sh,
    sw,
    addi,
    slti,
    sltiu,
    xori,
    ori,
    andi,
    slli,
    srli,
    srai,
    add,
    sub,
    sll,
    slt,
    sltu,
    xor_,
    srl,
    sra,
    or_,
    and_,
    mul,
    mulh,
    mulhsu,
    mulhu,
    div,
    divu,
    rem,
    remu,
    fence,  // and fence.i, and what empties VexRiscv's caches
    ecall,
    ebreak,
    csr,  // any access of a control and status register, whose number is in the lower 12 bits of immediate
    wfi,
    // No instructions, but what Code has in the place of some.
    intercepted,
    jump_outside,    // jal to where there is no code, or the end of the code
    branch_outside,  // a branch to where there is no code
};

/// Fields that an operation does not have are 0.
struct Instruction {
    Operation operation = Operation::illegal;
    std::uint8_t rd = 0;
    std::uint8_t rs1 = 0;
    std::uint8_t rs2 = 0;
    std::int32_t immediate = 0;  // as it is added: lui's and auipc's in its upper 20 bits; for shifts, 0 to 31

    bool operator==(Instruction const&) const = default;
};

Instruction decode(std::uint32_t word);

}  // namespace pogosim
