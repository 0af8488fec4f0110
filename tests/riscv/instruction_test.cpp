#include "riscv/instruction.hpp"

#include <gtest/gtest.h>

#include <string_view>

#include "riscv/assembler.hpp"

namespace {

using namespace pogosim;
using namespace pogosim::testing;

TEST(RiscvInstruction, EveryEncodingOfTheManualIsReadWithItsFields) {
    for (Encoding const& encoding : kEncodings) {
        SCOPED_TRACE(static_cast<int>(encoding.operation));
        bool const is_upper = encoding.format == 'U';
        bool const is_jump = encoding.format == 'B' || encoding.format == 'J';
        for (std::int32_t const immediate : {0, 1, 2, 30, -2, 1024, -2048}) {
            if (encoding.operation == Operation::csr && immediate == -2) {
                continue;  // a register that can only be read
            }
            Fields const fields{31, 1, 17, is_upper ? immediate * 4096 : is_jump ? immediate / 2 * 2 : immediate};
            Instruction const read = decode(encode(encoding, fields));
            EXPECT_EQ(read.operation, encoding.operation);
            bool const has_rd = std::string_view("RIHUJ").find(encoding.format) != std::string_view::npos;
            bool const has_rs1 = std::string_view("RIHSB").find(encoding.format) != std::string_view::npos;
            bool const has_rs2 = std::string_view("RSB").find(encoding.format) != std::string_view::npos;
            EXPECT_EQ(read.rd, has_rd ? 31 : 0);
            EXPECT_EQ(read.rs1, has_rs1 ? 1 : 0);
            EXPECT_EQ(read.rs2, has_rs2 ? 17 : 0);
            std::int32_t const expected = encoding.format == 'H' ? fields.immediate & 31 : fields.immediate;
            EXPECT_EQ(read.immediate, encoding.format == 'R' || encoding.format == 'N' ? 0 : expected);
        }
    }
}

TEST(RiscvInstruction, JumpsReachAsFarAsTheirFormatsDo) {
    EXPECT_EQ(decode(encode(Operation::jal, {.immediate = 1048574})).immediate, 1048574);
    EXPECT_EQ(decode(encode(Operation::jal, {.immediate = -1048576})).immediate, -1048576);
    EXPECT_EQ(decode(encode(Operation::beq, {.immediate = 4094})).immediate, 4094);
    EXPECT_EQ(decode(encode(Operation::beq, {.immediate = -4096})).immediate, -4096);
}

// As GNU as 2.40 assembles them.
TEST(RiscvInstruction, WordsOfAnAssemblerAreRead) {
    EXPECT_EQ(decode(0xfe010113), (Instruction{Operation::addi, 2, 2, 0, -32}));   // addi sp,sp,-32
    EXPECT_EQ(decode(0x00112e23), (Instruction{Operation::sw, 0, 2, 1, 28}));      // sw ra,28(sp)
    EXPECT_EQ(decode(0x00008067), (Instruction{Operation::jalr, 0, 1, 0, 0}));     // ret
    EXPECT_EQ(decode(0x41f55793), (Instruction{Operation::srai, 15, 10, 0, 31}));  // srai a5,a0,31
    EXPECT_EQ(decode(0xfe079ee3), (Instruction{Operation::bne, 0, 15, 0, -4}));    // bnez a5,.-4
    EXPECT_EQ(decode(0x02f757b3), (Instruction{Operation::divu, 15, 14, 15, 0}));  // divu a5,a4,a5
}

TEST(RiscvInstruction, WhatTheProcessorLacksIsIllegal) {
    for (std::uint32_t const word :
         {0x00000000U, 0xffffffffU, 0x00004501U /* c.li */, 0x00054573U /* no access of a register */,
          0xc0001073U /* unimp: csrw cycle */, 0xc0056573U /* csrsi cycle */, 0x100522afU /* lr.w */,
          0x00052507U /* flw */, 0x00b57553U /* fadd.s */, 0x30200073U /* mret */, 0x00053503U /* ld */,
          0x00b53023U /* sd */, 0x0255153bU /* a word of RV64 */, 0x02051513U /* slli by 32 */,
          0x40051513U /* slli with bit 30 */, 0x00200073U, 0x00008073U}) {
        EXPECT_EQ(decode(word), Instruction{}) << std::hex << word;
    }
}

TEST(RiscvInstruction, AccessesOfControlAndStatusRegistersAreRead) {
    EXPECT_EQ(decode(0x30529073), (Instruction{Operation::csr, 0, 5, 0, 0x305}));            // csrw mtvec, t0
    EXPECT_EQ(decode(0xc0002573), (Instruction{Operation::csr, 10, 0, 0, 0xc00 - 0x1000}));  // rdcycle a0
    EXPECT_EQ(decode(0x30046073), (Instruction{Operation::csr, 0, 8, 0, 0x300}));            // csrsi mstatus, 8
    EXPECT_EQ(decode(0x10500073), Instruction{.operation = Operation::wfi});
}

TEST(RiscvInstruction, WhatEmptiesCachesIsAFence) {
    EXPECT_EQ(decode(0x0000100f).operation, Operation::fence);  // fence.i
    EXPECT_EQ(decode(0x0000500f).operation, Operation::fence);  // as LiteX empties the data cache of a VexRiscv
    EXPECT_EQ(decode(0x0000200f).operation, Operation::illegal);
}

TEST(RiscvInstruction, ReservedFieldsOfFencesAreIgnored) {
    EXPECT_EQ(decode(0x8330000f).operation, Operation::fence);  // fence.tso
    EXPECT_EQ(decode(0x0ff50f8f), Instruction{.operation = Operation::fence});
}

}  // namespace
