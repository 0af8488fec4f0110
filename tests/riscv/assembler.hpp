// Makes words of instructions, by the formats of the manual (section 2.2), for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "riscv/instruction.hpp"

namespace pogosim::testing {

/// Fields as in the manual: opcode, funct3, and funct7 or the upper bits of a shift's immediate.
struct Encoding {
    Operation operation;
    char format;  // R, I, S, B, U, J; H: a shift by an immediate; N: a word without fields
    std::uint32_t opcode;
    std::uint32_t funct3 = 0;
    std::uint32_t funct7 = 0;
};

/// The table "RV32I Base Instruction Set" and "RV32M Standard Extension" of chapter 24.
inline constexpr Encoding kEncodings[] = {
    {Operation::lui, 'U', 0x37},          {Operation::auipc, 'U', 0x17},       {Operation::jal, 'J', 0x6f},
    {Operation::jalr, 'I', 0x67, 0},      {Operation::beq, 'B', 0x63, 0},      {Operation::bne, 'B', 0x63, 1},
    {Operation::blt, 'B', 0x63, 4},       {Operation::bge, 'B', 0x63, 5},      {Operation::bltu, 'B', 0x63, 6},
    {Operation::bgeu, 'B', 0x63, 7},      {Operation::lb, 'I', 0x03, 0},       {Operation::lh, 'I', 0x03, 1},
    {Operation::lw, 'I', 0x03, 2},        {Operation::lbu, 'I', 0x03, 4},      {Operation::lhu, 'I', 0x03, 5},
    {Operation::sb, 'S', 0x23, 0},        {Operation::sh, 'S', 0x23, 1},       {Operation::sw, 'S', 0x23, 2},
    {Operation::addi, 'I', 0x13, 0},      {Operation::slti, 'I', 0x13, 2},     {Operation::sltiu, 'I', 0x13, 3},
    {Operation::xori, 'I', 0x13, 4},      {Operation::ori, 'I', 0x13, 6},      {Operation::andi, 'I', 0x13, 7},
    {Operation::slli, 'H', 0x13, 1, 0},   {Operation::srli, 'H', 0x13, 5, 0},  {Operation::srai, 'H', 0x13, 5, 32},
    {Operation::add, 'R', 0x33, 0, 0},    {Operation::sub, 'R', 0x33, 0, 32},  {Operation::sll, 'R', 0x33, 1, 0},
    {Operation::slt, 'R', 0x33, 2, 0},    {Operation::sltu, 'R', 0x33, 3, 0},  {Operation::xor_, 'R', 0x33, 4, 0},
    {Operation::srl, 'R', 0x33, 5, 0},    {Operation::sra, 'R', 0x33, 5, 32},  {Operation::or_, 'R', 0x33, 6, 0},
    {Operation::and_, 'R', 0x33, 7, 0},   {Operation::mul, 'R', 0x33, 0, 1},   {Operation::mulh, 'R', 0x33, 1, 1},
    {Operation::mulhsu, 'R', 0x33, 2, 1}, {Operation::mulhu, 'R', 0x33, 3, 1}, {Operation::div, 'R', 0x33, 4, 1},
    {Operation::divu, 'R', 0x33, 5, 1},   {Operation::rem, 'R', 0x33, 6, 1},   {Operation::remu, 'R', 0x33, 7, 1},
    {Operation::fence, 'N', 0x0ff0000f},  {Operation::ecall, 'N', 0x00000073}, {Operation::ebreak, 'N', 0x00100073},
    {Operation::wfi, 'N', 0x10500073},    {Operation::csr, 'I', 0x73, 2},
};

inline Encoding const& encoding_of(Operation operation) {
    for (Encoding const& encoding : kEncodings) {
        if (encoding.operation == operation) {
            return encoding;
        }
    }
    return kEncodings[0];
}

struct Fields {
    std::uint32_t rd = 0;
    std::uint32_t rs1 = 0;
    std::uint32_t rs2 = 0;
    std::int32_t immediate = 0;
};

inline std::uint32_t encode(Encoding const& encoding, Fields const& fields) {
    auto const u = static_cast<std::uint32_t>(fields.immediate);
    std::uint32_t const with_funct3 = encoding.opcode | encoding.funct3 << 12;
    std::uint32_t const rd = fields.rd << 7;
    std::uint32_t const rs1 = fields.rs1 << 15;
    std::uint32_t const rs2 = fields.rs2 << 20;
    switch (encoding.format) {
        case 'R':
            return with_funct3 | rd | rs1 | rs2 | encoding.funct7 << 25;
        case 'I':
            return with_funct3 | rd | rs1 | u << 20;
        case 'H':
            return with_funct3 | rd | rs1 | (u & 31) << 20 | encoding.funct7 << 25;
        case 'S':
            return with_funct3 | rs1 | rs2 | (u & 31) << 7 | (u >> 5 & 127) << 25;
        case 'B':
            return with_funct3 | rs1 | rs2 | (u >> 11 & 1) << 7 | (u >> 1 & 15) << 8 | (u >> 5 & 63) << 25 |
                   (u >> 12 & 1) << 31;
        case 'U':
            return encoding.opcode | rd | (u & 0xfffff000U);
        case 'J':
            return encoding.opcode | rd | (u >> 12 & 255) << 12 | (u >> 11 & 1) << 20 | (u >> 1 & 1023) << 21 |
                   (u >> 20 & 1) << 31;
        default:
            return encoding.opcode;
    }
}

inline std::uint32_t encode(Operation operation, Fields const& fields = {}) {
    return encode(encoding_of(operation), fields);
}

/// Words as they are in memory.
inline std::vector<std::byte> bytes_of(std::vector<std::uint32_t> const& words) {
    std::vector<std::byte> bytes;
    for (std::uint32_t const word : words) {
        for (int shift = 0; shift < 32; shift += 8) {
            bytes.push_back(static_cast<std::byte>(word >> shift));
        }
    }
    return bytes;
}

}  // namespace pogosim::testing
