// What a step of the processor does, written a second time and plainly: word by word, with numbers of 64 bits and no
// more in common with src/riscv than the manual.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pogosim::testing {

struct ReferenceCore {
    std::array<std::uint32_t, 32> x{};
    std::uint32_t pc = 0;
    std::vector<std::uint8_t> memory;  // from address 0
    std::uint32_t code_bytes = 0;      // the first ones of it
    std::int64_t cycles = 0;           // that its counter shows

    /// Executes an instruction; false, without any effect, if it cannot be.
    bool step() {
        if (pc % 4 != 0 || pc >= code_bytes) {
            return false;
        }
        std::int64_t const word = read(pc, 4);
        std::int64_t const rd = word / 128 % 32;
        std::int64_t const kind = word / 4096 % 8;
        std::int64_t const upper = word / 33554432;  // the last 7 bits
        std::int64_t const a = x[static_cast<std::size_t>(word / 32768 % 32)];
        std::int64_t const b = x[static_cast<std::size_t>(word / 1048576 % 32)];
        std::int64_t const number = with_sign(word / 1048576, 12);
        switch (word % 128) {
            case 0x37:
                return result(rd, word / 4096 * 4096);
            case 0x17:
                return result(rd, pc + word / 4096 * 4096);
            case 0x6f: {
                std::int64_t const distance = with_sign(word / 2147483648 * 1048576 + word / 4096 % 256 * 4096 +
                                                            word / 1048576 % 2 * 2048 + word / 2097152 % 1024 * 2,
                                                        21);
                return jump(rd, pc + distance);
            }
            case 0x67:
                return kind == 0 && jump(rd, divided_downwards(a + number, 2) * 2);
            case 0x63: {
                std::int64_t const distance =
                    with_sign(upper / 64 * 4096 + rd % 2 * 2048 + upper % 64 * 32 + rd / 2 * 2, 13);
                return branch(kind, a, b, distance);
            }
            case 0x03:
                return load(rd, kind, a + number);
            case 0x23:
                return store(kind, a + with_sign(upper * 32 + rd, 12), b);
            case 0x13:
                if (kind == 1 || kind == 5) {
                    bool const is_known = upper == 0 || (upper == 32 && kind == 5);
                    return is_known && result(rd, calculated(kind, upper, a, word / 1048576 % 32));
                }
                return result(rd, calculated(kind, 0, a, number));
            case 0x33:
                if (upper == 1) {
                    return result(rd, multiplied(kind, a, b));
                }
                return (upper == 0 || (upper == 32 && (kind == 0 || kind == 5))) &&
                       result(rd, calculated(kind, upper, a, b));
            case 0x0f:
                return (kind == 0 || kind == 1 || kind == 5) && go_to(pc + 4);
            case 0x73:
                return kind % 4 != 0 && !(upper >= 96 && (kind % 4 == 1 || word / 32768 % 32 != 0)) &&
                       result(rd, control_register(word / 1048576));
            default:
                return false;  // ecall and ebreak stop, too
        }
    }

private:
    static std::int64_t with_sign(std::int64_t value, int bits) {
        std::int64_t const range = std::int64_t{1} << bits;
        return value >= range / 2 ? value - range : value;
    }

    static std::int64_t as_signed(std::int64_t value) { return with_sign(low(value), 32); }

    static std::int64_t low(std::int64_t value) {
        std::int64_t const range = std::int64_t{1} << 32;
        return (value % range + range) % range;
    }

    static std::int64_t divided_downwards(std::int64_t value, std::int64_t by) {
        return (value - ((value % by) + by) % by) / by;
    }

    std::int64_t control_register(std::int64_t number) const {
        std::int64_t const low_half = std::int64_t{1} << 32;
        bool const is_counter = number % 256 == 0 && (number / 256 == 11 || number / 256 == 12);
        bool const is_upper_half = number % 256 == 128 && (number / 256 == 11 || number / 256 == 12);
        return is_counter ? cycles % low_half : is_upper_half ? cycles / low_half : 0;
    }

    bool go_to(std::int64_t address) {
        pc = static_cast<std::uint32_t>(low(address));
        return true;
    }

    bool result(std::int64_t rd, std::int64_t value) {
        if (rd != 0) {
            x[static_cast<std::size_t>(rd)] = static_cast<std::uint32_t>(low(value));
        }
        return go_to(pc + std::int64_t{4});
    }

    bool jump(std::int64_t rd, std::int64_t target) {
        target = low(target);
        return target % 4 == 0 && target < code_bytes && result(rd, pc + std::int64_t{4}) && go_to(target);
    }

    bool branch(std::int64_t kind, std::int64_t a, std::int64_t b, std::int64_t distance) {
        bool const is_less = kind < 6 ? as_signed(a) < as_signed(b) : a < b;
        bool const condition = kind < 2 ? a == b : is_less;
        if (kind == 2 || kind == 3) {
            return false;
        }
        return condition == (kind % 2 == 0) ? jump(0, pc + distance) : go_to(pc + std::int64_t{4});
    }

    static std::int64_t calculated(std::int64_t kind, std::int64_t upper, std::int64_t a, std::int64_t b) {
        std::int64_t const power = std::int64_t{1} << (low(b) % 32);
        switch (kind) {
            case 0:
                return upper == 32 ? a - b : a + b;
            case 1:
                return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(power) %
                                                 (std::uint64_t{1} << 32));
            case 2:
                return as_signed(a) < as_signed(b) ? 1 : 0;
            case 3:
                return low(a) < low(b) ? 1 : 0;
            case 4:
                return low(a) ^ low(b);
            case 5:
                return upper == 32 ? divided_downwards(as_signed(a), power) : a / power;
            case 6:
                return low(a) | low(b);
            default:
                return low(a) & low(b);
        }
    }

    /// The upper half of the product of a and b, from products of 16 bits by 32: no sum of them needs more than 64.
    static std::int64_t upper_half(std::int64_t a, std::int64_t b) {
        std::int64_t const b_low = low(b) % 65536;
        std::int64_t const b_high = divided_downwards(b, 65536);
        return divided_downwards(a * b_high + divided_downwards(a * b_low, 65536), 65536);
    }

    static std::int64_t multiplied(std::int64_t kind, std::int64_t a, std::int64_t b) {
        std::int64_t const signed_a = as_signed(a);
        std::int64_t const signed_b = as_signed(b);
        switch (kind) {
            case 0:
                return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b) %
                                                 (std::uint64_t{1} << 32));
            case 1:
                return upper_half(signed_a, signed_b);
            case 2:
                return upper_half(signed_a, b);
            case 3:
                return upper_half(a, b);
            case 4:
                return b == 0 ? -1 : signed_a / signed_b;
            case 5:
                return b == 0 ? -1 : a / b;
            case 6:
                return b == 0 ? a : signed_a % signed_b;
            default:
                return b == 0 ? a : a % b;
        }
    }

    std::int64_t read(std::int64_t address, std::int64_t bytes) const {
        std::int64_t value = 0;
        for (std::int64_t i = bytes; i-- > 0;) {
            value = value * 256 + memory[static_cast<std::size_t>(address + i)];
        }
        return value;
    }

    bool load(std::int64_t rd, std::int64_t kind, std::int64_t address) {
        address = low(address);
        std::int64_t const bytes = std::int64_t{1} << (kind % 4);
        if (kind == 3 || kind > 5 || address % bytes != 0 || address >= std::ssize(memory)) {
            return false;
        }
        std::int64_t const value = read(address, bytes);
        return result(rd, kind < 4 ? with_sign(value, static_cast<int>(8 * bytes)) : value);
    }

    bool store(std::int64_t kind, std::int64_t address, std::int64_t value) {
        address = low(address);
        std::int64_t const bytes = std::int64_t{1} << kind;
        if (kind > 2 || address % bytes != 0 || address < code_bytes || address >= std::ssize(memory)) {
            return false;
        }
        for (std::int64_t i = 0; i < bytes; ++i) {
            memory[static_cast<std::size_t>(address + i)] = static_cast<std::uint8_t>(value % 256);
            value /= 256;
        }
        return go_to(pc + std::int64_t{4});
    }
};

}  // namespace pogosim::testing
