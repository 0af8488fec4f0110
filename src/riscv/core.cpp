#include "riscv/core.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace pogosim {

namespace {

/// x0 to x31, then one for results that nothing reads.
using Registers = std::array<std::uint32_t, 33>;

struct Position {
    Step const* step;
    std::int64_t cycles;     // that were left before the sum of all steps in front of it, see Code
    Step const* not_looked;  // where caches count: the first step since the last jump that has not been looked up yet
};

/// Why a part of a run ended, and where: no instruction was begun there.
struct Outcome {
    Position at;
    StopReason reason;
    std::uint32_t address = 0;
};

constexpr std::int32_t as_signed(std::uint32_t value) {
    return static_cast<std::int32_t>(value);
}

constexpr std::uint32_t as_unsigned(std::int32_t value) {
    return static_cast<std::uint32_t>(value);
}

/// The upper half of a product.
constexpr std::uint32_t upper(std::uint64_t product) {
    return static_cast<std::uint32_t>(product >> 32);
}

/// With its sign.
constexpr std::int64_t wide(std::uint32_t value) {
    return as_signed(value);
}

// Division by zero, and the quotient that does not fit, have results (table 7.1 of the manual).
constexpr bool overflows(std::uint32_t dividend, std::uint32_t divisor) {
    return dividend == 0x80000000U && divisor == 0xffffffffU;
}

constexpr std::uint32_t quotient(std::uint32_t a, std::uint32_t b) {
    return b == 0 ? 0xffffffffU : overflows(a, b) ? a : as_unsigned(as_signed(a) / as_signed(b));
}

constexpr std::uint32_t remainder(std::uint32_t a, std::uint32_t b) {
    return b == 0 ? a : overflows(a, b) ? 0 : as_unsigned(as_signed(a) % as_signed(b));
}

bool is_taken(Operation branch, std::uint32_t a, std::uint32_t b) {
    switch (branch) {
        case Operation::beq:
            return a == b;
        case Operation::bne:
            return a != b;
        case Operation::blt:
            return as_signed(a) < as_signed(b);
        case Operation::bge:
            return as_signed(a) >= as_signed(b);
        case Operation::bltu:
            return a < b;
        default:
            return a >= b;
    }
}

// What stops execute() at an access of a control and status register, which is done outside: it is rare.
constexpr auto kAccessesRegister = static_cast<StopReason>(0xff);

/// What a control and status register contains. Source: The RISC-V Instruction Set Manual, Volume II: Privileged
/// Architecture, version 20211203, table 2.5.
std::uint32_t read_register(std::uint32_t number, std::uint64_t cycles) {
    switch (number & 0xfffU) {
        case 0xb00:  // mcycle
        case 0xc00:  // cycle
            return static_cast<std::uint32_t>(cycles);
        case 0xb80:  // mcycleh
        case 0xc80:  // cycleh
            return upper(cycles);
        default:
            return 0;
    }
}

/// How many bits a shift has beyond the first.
constexpr std::int64_t further_bits(std::uint32_t shift) {
    return std::max<std::int64_t>(shift % 32, 1) - 1;
}

std::uint32_t address_of(Step const* step, Code const& code) {
    return code.address + static_cast<std::uint32_t>(4 * (step - code.steps.data()));
}

std::int64_t cycles_left(Position at, Code const& code) {
    return at.cycles - code.cycles_before[static_cast<std::size_t>(at.step - code.steps.data())];
}

/// What jalr to another step adds to (cycles that have passed) - (cycles_before).
std::int64_t jump_cycles(Step const* jump, Step const* target, Code const& code) {
    Step const* const first = code.steps.data();
    return std::int64_t{code.cycles_before[static_cast<std::size_t>(jump - first)]} + jump->other_cycles -
           code.cycles_before[static_cast<std::size_t>(target - first)];
}

/// Looks up the steps in front of one that have been executed since the last jump. What a miss takes counts late, but
/// before the core looks for the end of its budget.
void look_up(Step const* end, Code const& code, Position& at, InstructionCache& cache) {
    if (at.not_looked == end) {
        return;
    }
    std::uint32_t const last = cache_line(address_of(end - 1, code));
    for (std::uint32_t line = cache_line(address_of(at.not_looked, code)); line <= last; ++line) {
        at.cycles -= cache.fetches(line) ? code.cache_miss : 0;
    }
    at.not_looked = end;
}

void jump_to(Step const* target, Position& at) {
    at.step = target;
    at.not_looked = target;
}

void branch(bool is_taken, Position& at) {
    if (is_taken) {
        at.cycles -= at.step->other_cycles;
        jump_to(at.step + at.step->immediate, at);
    } else {
        ++at.step;
    }
}

/// False, without any effect, if that is a fault. Number says how many bytes, and whether they have a sign.
template <class Number>
bool load(Memory const& memory, std::uint32_t address, std::uint32_t& destination) {
    std::byte const* const place = memory.readable<sizeof(Number)>(address);
    if (place == nullptr) [[unlikely]] {
        return false;
    }
    destination = static_cast<std::uint32_t>(static_cast<Number>(read_little_endian<sizeof(Number)>(place)));
    return true;
}

/// The same, also for a place in the code.
template <class Number>
bool store(Memory& memory, std::uint32_t address, std::uint32_t value, Code const& code) {
    if (address - code.address < code.bytes()) [[unlikely]] {
        return false;
    }
    std::byte* const place = memory.writable<sizeof(Number)>(address);
    if (place == nullptr) [[unlikely]] {
        return false;
    }
    write_little_endian<sizeof(Number)>(place, value);
    return true;
}

StopReason reason_of(AccessFault fault) {
    switch (fault) {
        case AccessFault::unaligned:
            return StopReason::unaligned_access;
        case AccessFault::read_only:
            return StopReason::store_into_flash;
        case AccessFault::outside:
            return StopReason::outside_access;
        case AccessFault::none:
            break;
    }
    return StopReason::store_into_code;
}

// Each operation ends with a jump to that of the next step, so that the processor of this machine predicts each of
// these jumps on its own: a switch in a loop, with one jump for all, took twice as long (bench_riscv).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"  // addresses of labels are an extension of gcc and clang

#define POGOSIM_GO_ON                                                \
    do {                                                             \
        if (LooksAtEachStep && cycles_left(at, code) <= 0) {         \
            return {at, StopReason::budget_used};                    \
        }                                                            \
        a = x[at.step->rs1];                                         \
        b = x[at.step->rs2];                                         \
        immediate = as_unsigned(at.step->immediate);                 \
        address = a + immediate;                                     \
        goto* kLabels[static_cast<std::size_t>(at.step->operation)]; \
    } while (false)

// The step has been executed, and the next one may be anywhere.
#define POGOSIM_LOOK_UP                            \
    do {                                           \
        if (CountsMisses) {                        \
            look_up(at.step + 1, code, at, cache); \
        }                                          \
    } while (false)

#define POGOSIM_NEXT           \
    do {                       \
        if (LooksAtEachStep) { \
            POGOSIM_LOOK_UP;   \
        }                      \
        ++at.step;             \
        POGOSIM_GO_ON;         \
    } while (false)

// After what has changed the sum of cycles.
#define POGOSIM_LOOK_AND_GO_ON                                         \
    do {                                                               \
        if (!LooksAtEachStep && at.cycles <= at.step->cycles_to_end) { \
            return {at, StopReason::budget_used};                      \
        }                                                              \
        POGOSIM_GO_ON;                                                 \
    } while (false)

/// Executes steps until the core has to stop. Without LooksAtEachStep, it looks at its budget only where the sum of
/// cycles may change, and returns budget_used as soon as the budget might end before the next look.
template <bool LooksAtEachStep, bool CountsMisses>
Outcome execute(Registers& x, Memory& memory, InstructionCache& cache, Code const& code, Position at) {
    // In the order of Operation.
    static constexpr void const* kLabels[] = {
        &&illegal, &&lui,   &&auipc, &&jal,    &&jalr,   &&beq,   &&bne,         &&blt,          &&bge,
        &&bltu,    &&bgeu,  &&lb,    &&lh,     &&lw,     &&lbu,   &&lhu,         &&sb,           &&sh,
        &&sw,      &&addi,  &&slti,  &&sltiu,  &&xori,   &&ori,   &&andi,        &&slli,         &&srli,
        &&srai,    &&add,   &&sub,   &&sll,    &&slt,    &&sltu,  &&xor_,        &&srl,          &&sra,
        &&or_,     &&and_,  &&mul,   &&mulh,   &&mulhsu, &&mulhu, &&div,         &&divu,         &&rem,
        &&remu,    &&fence, &&ecall, &&ebreak, &&csr,    &&wfi,   &&intercepted, &&jump_outside, &&branch_outside};
    static_assert(std::size(kLabels) == static_cast<std::size_t>(Operation::branch_outside) + 1);

    std::uint32_t a = 0;  // rs1
    std::uint32_t b = 0;  // rs2
    std::uint32_t immediate = 0;
    std::uint32_t address = 0;  // rs1 + immediate
    POGOSIM_GO_ON;

lui:
    x[at.step->rd] = immediate;
    POGOSIM_NEXT;
addi:
    x[at.step->rd] = a + immediate;
    POGOSIM_NEXT;
slti:
    x[at.step->rd] = as_signed(a) < as_signed(immediate) ? 1 : 0;
    POGOSIM_NEXT;
sltiu:
    x[at.step->rd] = a < immediate ? 1 : 0;
    POGOSIM_NEXT;
xori:
    x[at.step->rd] = a ^ immediate;
    POGOSIM_NEXT;
ori:
    x[at.step->rd] = a | immediate;
    POGOSIM_NEXT;
andi:
    x[at.step->rd] = a & immediate;
    POGOSIM_NEXT;
slli:
    x[at.step->rd] = a << immediate;
    POGOSIM_NEXT;
srli:
    x[at.step->rd] = a >> immediate;
    POGOSIM_NEXT;
srai:
    x[at.step->rd] = as_unsigned(as_signed(a) >> immediate);
    POGOSIM_NEXT;
add:
    x[at.step->rd] = a + b;
    POGOSIM_NEXT;
sub:
    x[at.step->rd] = a - b;
    POGOSIM_NEXT;
slt:
    x[at.step->rd] = as_signed(a) < as_signed(b) ? 1 : 0;
    POGOSIM_NEXT;
sltu:
    x[at.step->rd] = a < b ? 1 : 0;
    POGOSIM_NEXT;
xor_:
    x[at.step->rd] = a ^ b;
    POGOSIM_NEXT;
or_:
    x[at.step->rd] = a | b;
    POGOSIM_NEXT;
and_:
    x[at.step->rd] = a & b;
    POGOSIM_NEXT;
sll:
    x[at.step->rd] = a << (b % 32);
    POGOSIM_LOOK_UP;
    at.cycles -= further_bits(b) * at.step->other_cycles;
    ++at.step;
    POGOSIM_LOOK_AND_GO_ON;
srl:
    x[at.step->rd] = a >> (b % 32);
    POGOSIM_LOOK_UP;
    at.cycles -= further_bits(b) * at.step->other_cycles;
    ++at.step;
    POGOSIM_LOOK_AND_GO_ON;
sra:
    x[at.step->rd] = as_unsigned(as_signed(a) >> (b % 32));
    POGOSIM_LOOK_UP;
    at.cycles -= further_bits(b) * at.step->other_cycles;
    ++at.step;
    POGOSIM_LOOK_AND_GO_ON;

mul:
    x[at.step->rd] = a * b;
    POGOSIM_NEXT;
mulh:
    x[at.step->rd] = upper(static_cast<std::uint64_t>(wide(a) * wide(b)));
    POGOSIM_NEXT;
mulhsu:
    x[at.step->rd] = upper(static_cast<std::uint64_t>(wide(a) * std::int64_t{b}));
    POGOSIM_NEXT;
mulhu:
    x[at.step->rd] = upper(std::uint64_t{a} * b);
    POGOSIM_NEXT;
div:
    x[at.step->rd] = quotient(a, b);
    POGOSIM_NEXT;
divu:
    x[at.step->rd] = b == 0 ? 0xffffffffU : a / b;
    POGOSIM_NEXT;
rem:
    x[at.step->rd] = remainder(a, b);
    POGOSIM_NEXT;
remu:
    x[at.step->rd] = b == 0 ? a : a % b;
    POGOSIM_NEXT;

lb:
    if (!load<std::int8_t>(memory, address, x[at.step->rd])) {
        return {at, reason_of(memory.fault_of_load(address, 1)), address};
    }
    POGOSIM_NEXT;
lh:
    if (!load<std::int16_t>(memory, address, x[at.step->rd])) {
        return {at, reason_of(memory.fault_of_load(address, 2)), address};
    }
    POGOSIM_NEXT;
lw:
    if (!load<std::uint32_t>(memory, address, x[at.step->rd])) {
        return {at, reason_of(memory.fault_of_load(address, 4)), address};
    }
    POGOSIM_NEXT;
lbu:
    if (!load<std::uint8_t>(memory, address, x[at.step->rd])) {
        return {at, reason_of(memory.fault_of_load(address, 1)), address};
    }
    POGOSIM_NEXT;
lhu:
    if (!load<std::uint16_t>(memory, address, x[at.step->rd])) {
        return {at, reason_of(memory.fault_of_load(address, 2)), address};
    }
    POGOSIM_NEXT;
sb:
    if (!store<std::uint8_t>(memory, address, b, code)) {
        return {at, reason_of(memory.fault_of_store(address, 1)), address};
    }
    POGOSIM_NEXT;
sh:
    if (!store<std::uint16_t>(memory, address, b, code)) {
        return {at, reason_of(memory.fault_of_store(address, 2)), address};
    }
    POGOSIM_NEXT;
sw:
    if (!store<std::uint32_t>(memory, address, b, code)) {
        return {at, reason_of(memory.fault_of_store(address, 4)), address};
    }
    POGOSIM_NEXT;

beq:
    POGOSIM_LOOK_UP;
    branch(a == b, at);
    POGOSIM_LOOK_AND_GO_ON;
bne:
    POGOSIM_LOOK_UP;
    branch(a != b, at);
    POGOSIM_LOOK_AND_GO_ON;
blt:
    POGOSIM_LOOK_UP;
    branch(as_signed(a) < as_signed(b), at);
    POGOSIM_LOOK_AND_GO_ON;
bge:
    POGOSIM_LOOK_UP;
    branch(as_signed(a) >= as_signed(b), at);
    POGOSIM_LOOK_AND_GO_ON;
bltu:
    POGOSIM_LOOK_UP;
    branch(a < b, at);
    POGOSIM_LOOK_AND_GO_ON;
bgeu:
    POGOSIM_LOOK_UP;
    branch(a >= b, at);
    POGOSIM_LOOK_AND_GO_ON;
jal:
    x[at.step->rd] = address_of(at.step, code) + 4;
    POGOSIM_LOOK_UP;
    branch(true, at);
    POGOSIM_LOOK_AND_GO_ON;
jalr : {
    std::uint32_t const target = address & ~1U;
    Step const* const next = code.step_at(target);
    if (next == nullptr) [[unlikely]] {
        return {at, StopReason::jump_outside, target};
    }
    x[at.step->rd] = address_of(at.step, code) + 4;
    POGOSIM_LOOK_UP;
    at.cycles -= jump_cycles(at.step, next, code);
    jump_to(next, at);
    POGOSIM_LOOK_AND_GO_ON;
}

fence:  // one core sees its own accesses in order
    POGOSIM_NEXT;
branch_outside:
    if (is_taken(static_cast<Operation>(at.step->rd), a, b)) {
        return {at, StopReason::jump_outside, immediate};
    }
    POGOSIM_NEXT;
jump_outside:
    return {at, StopReason::jump_outside, immediate};
intercepted:
    return {at, StopReason::intercepted};
ecall:
    return {at, StopReason::ecall};
ebreak:
    return {at, StopReason::ebreak};
csr:
    return {at, kAccessesRegister};
wfi:
    return {at, StopReason::wait_for_interrupt};
illegal:
auipc:  // has become lui
    return {at, StopReason::illegal_instruction};
}

#undef POGOSIM_LOOK_AND_GO_ON
#undef POGOSIM_NEXT
#undef POGOSIM_LOOK_UP
#undef POGOSIM_GO_ON
#pragma GCC diagnostic pop

constexpr std::uint64_t kMostCycles = std::numeric_limits<std::int64_t>::max() / 2;

/// See run_instructions().
template <bool CountsMisses>
Outcome execute_until(Registers& x, Memory& memory, InstructionCache& cache, Code const& code, Position at) {
    Outcome outcome{at, StopReason::budget_used};
    if (at.cycles > at.step->cycles_to_end) {
        outcome = execute<false, CountsMisses>(x, memory, cache, code, at);
        if (CountsMisses) {
            look_up(outcome.at.step, code, outcome.at, cache);
        }
    }
    if (outcome.reason == StopReason::budget_used) {
        outcome = execute<true, CountsMisses>(x, memory, cache, code, outcome.at);
    }
    return outcome;
}

/// Runs until the end, or an instruction that is not executed here. `most_cycles` is not above kMostCycles.
Stop run_instructions(Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles) {
    Step const* const step = code.step_at(core.pc);
    if (step == nullptr) {
        return {StopReason::jump_outside, core.pc, core.pc};
    }
    Registers x{};
    std::ranges::copy(core.x, x.begin());
    x[0] = 0;
    auto const budget = static_cast<std::int64_t>(most_cycles);
    std::int64_t const begin = budget + code.cycles_before[static_cast<std::size_t>(step - code.steps.data())];
    Position const at{step, begin, step};
    Outcome const outcome = code.cache_miss > 0 ? execute_until<true>(x, memory, core.cache, code, at)
                                                : execute_until<false>(x, memory, core.cache, code, at);

    std::copy_n(x.begin(), core.x.size(), core.x.begin());
    core.pc = address_of(outcome.at.step, code);
    core.cycles += static_cast<std::uint64_t>(budget - cycles_left(outcome.at, code));
    return {outcome.reason, core.pc, outcome.address};
}

/// Executes the instruction at pc, which accesses a control and status register.
void access_register(Core& core, Code const& code) {
    Step const& step = *code.step_at(core.pc);
    auto const index = static_cast<std::size_t>(&step - code.steps.data());
    std::uint32_t const value = read_register(as_unsigned(step.immediate), core.cycles);
    if (step.rd != kUnread) {
        core.x[step.rd] = value;
    }
    core.cycles += code.cycles_before[index + 1] - code.cycles_before[index];
    if (code.cache_miss > 0 && core.cache.fetches(cache_line(core.pc))) {
        core.cycles += code.cache_miss;
    }
    core.pc += 4;
}

}  // namespace

Stop run(Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles) {
    std::uint64_t const end = core.cycles + std::min(most_cycles, kMostCycles);
    for (;;) {
        Stop const stop = run_instructions(core, memory, code, end - std::min(end, core.cycles));
        if (stop.reason != kAccessesRegister) {
            return stop;
        }
        access_register(core, code);
    }
}

}  // namespace pogosim
