#include "riscv/instruction.hpp"

#include <array>

namespace pogosim {

namespace {

using enum Operation;

/// Bits first to last of a word, both included.
constexpr std::uint32_t bits(std::uint32_t word, unsigned first, unsigned last) {
    return (word >> first) & ((1U << (last - first + 1)) - 1);
}

/// A number of so many bits, with its sign.
constexpr std::int32_t with_sign(std::uint32_t value, unsigned bits) {
    std::uint32_t const sign = 1U << (bits - 1);
    return static_cast<std::int32_t>((value ^ sign) - sign);
}

// Immediates by format of instruction (section 2.3 of the manual).
constexpr std::int32_t immediate_i(std::uint32_t word) {
    return with_sign(bits(word, 20, 31), 12);
}

constexpr std::int32_t immediate_s(std::uint32_t word) {
    return with_sign(bits(word, 25, 31) << 5 | bits(word, 7, 11), 12);
}

constexpr std::int32_t immediate_b(std::uint32_t word) {
    return with_sign(
        bits(word, 31, 31) << 12 | bits(word, 7, 7) << 11 | bits(word, 25, 30) << 5 | bits(word, 8, 11) << 1, 13);
}

constexpr std::int32_t immediate_u(std::uint32_t word) {
    return static_cast<std::int32_t>(word & 0xfffff000U);
}

constexpr std::int32_t immediate_j(std::uint32_t word) {
    return with_sign(
        bits(word, 31, 31) << 20 | bits(word, 12, 19) << 12 | bits(word, 20, 20) << 11 | bits(word, 21, 30) << 1, 21);
}

/// Operations by the field funct3.
using ByFunct3 = std::array<Operation, 8>;

constexpr ByFunct3 kBranches{beq, bne, illegal, illegal, blt, bge, bltu, bgeu};
constexpr ByFunct3 kLoads{lb, lh, lw, illegal, lbu, lhu, illegal, illegal};
constexpr ByFunct3 kStores{sb, sh, sw, illegal, illegal, illegal, illegal, illegal};
constexpr ByFunct3 kWithImmediate{addi, slli, slti, sltiu, xori, srli, ori, andi};
constexpr ByFunct3 kOfRegisters{add, sll, slt, sltu, xor_, srl, or_, and_};
constexpr ByFunct3 kMultiplications{mul, mulh, mulhsu, mulhu, div, divu, rem, remu};

// Values of the field funct7.
constexpr std::uint32_t kFenceInstructions = 1;  // funct3 of fence.i
constexpr std::uint32_t kFlushCache = 5;         // VexRiscv's own, funct3 beside those of fence and fence.i
constexpr std::uint32_t kNoAccess = 4;           // funct3 that no access of a control and status register has
constexpr std::uint32_t kOther = 0b0100000;      // subtraction, arithmetic shifts
constexpr std::uint32_t kMultiplication = 0b0000001;

Operation operation_with_immediate(std::uint32_t funct3, std::uint32_t funct7) {
    Operation const found = kWithImmediate[funct3];
    if (found == srli && funct7 == kOther) {
        return srai;
    }
    return (found == slli || found == srli) && funct7 != 0 ? illegal : found;
}

Operation operation_of_registers(std::uint32_t funct3, std::uint32_t funct7) {
    switch (funct7) {
        case 0:
            return kOfRegisters[funct3];
        case kMultiplication:
            return kMultiplications[funct3];
        case kOther:
            return kOfRegisters[funct3] == add ? sub : kOfRegisters[funct3] == srl ? sra : illegal;
        default:
            return illegal;
    }
}

}  // namespace

Instruction decode(std::uint32_t word) {
    auto const rd = static_cast<std::uint8_t>(bits(word, 7, 11));
    auto const rs1 = static_cast<std::uint8_t>(bits(word, 15, 19));
    auto const rs2 = static_cast<std::uint8_t>(bits(word, 20, 24));
    std::uint32_t const funct3 = bits(word, 12, 14);
    std::uint32_t const funct7 = bits(word, 25, 31);
    Instruction read;
    switch (bits(word, 0, 6)) {
        case 0b0110111:
            read = {lui, rd, 0, 0, immediate_u(word)};
            break;
        case 0b0010111:
            read = {auipc, rd, 0, 0, immediate_u(word)};
            break;
        case 0b1101111:
            read = {jal, rd, 0, 0, immediate_j(word)};
            break;
        case 0b1100111:
            read = {funct3 == 0 ? jalr : illegal, rd, rs1, 0, immediate_i(word)};
            break;
        case 0b1100011:
            read = {kBranches[funct3], 0, rs1, rs2, immediate_b(word)};
            break;
        case 0b0000011:
            read = {kLoads[funct3], rd, rs1, 0, immediate_i(word)};
            break;
        case 0b0100011:
            read = {kStores[funct3], 0, rs1, rs2, immediate_s(word)};
            break;
        case 0b0010011: {
            Operation const operation = operation_with_immediate(funct3, funct7);
            bool const is_shift = operation == slli || operation == srli || operation == srai;
            read = {operation, rd, rs1, 0, is_shift ? rs2 : immediate_i(word)};
            break;
        }
        case 0b0110011:
            read = {operation_of_registers(funct3, funct7), rd, rs1, rs2, 0};
            break;
        case 0b0001111:  // its other fields are reserved for finer fences, and to be ignored (section 2.7)
            read.operation = funct3 == 0 || funct3 == kFenceInstructions || funct3 == kFlushCache ? fence : illegal;
            break;
        case 0b1110011:
            if (funct3 != 0 && funct3 != kNoAccess) {
                bool const writes = funct3 % 4 == 1 || rs1 != 0;
                bool const is_read_only = bits(word, 30, 31) == 3;  // table 2.1 of the privileged architecture
                read = {writes && is_read_only ? illegal : csr, rd, rs1, 0, immediate_i(word)};
            } else {
                read.operation = word == 0x00000073   ? ecall
                                 : word == 0x00100073 ? ebreak
                                 : word == 0x10500073 ? wfi
                                                      : illegal;
            }
            break;
        default:
            break;
    }
    return read.operation == illegal ? Instruction{} : read;
}

}  // namespace pogosim
