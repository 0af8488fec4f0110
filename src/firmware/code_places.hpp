// Which function and line each instruction of a firmware belongs to, by its debug information (DWARF), with functions
// that the compiler has made a part of others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/firmware_program.hpp"

namespace pogosim {

class CodePlaces {
public:
    /// Functions by their numbers, outermost first: "main", then one that was inlined into it.
    using Chain = std::vector<std::uint32_t>;

    struct Line {
        std::string file;  // without its folder; empty: unknown
        int number = 0;
    };

    explicit CodePlaces(FirmwareProgram const& program);

    std::vector<std::string> const& functions() const { return functions_; }

    /// Whether there is an instruction at an address.
    bool is_code(std::uint32_t address) const { return (address - address_) / 4 < chain_of_.size(); }

    /// Whether a function begins at an address with code.
    bool is_entry(std::uint32_t address) const { return is_code(address) && is_entry_[word_of(address)]; }

    std::uint32_t word_of(std::uint32_t address) const { return (address - address_) / 4; }

    // The numbers of an instruction's chain and line.
    std::uint32_t chain_of(std::uint32_t address) const { return chain_of_[(address - address_) / 4]; }
    std::uint32_t line_of(std::uint32_t address) const { return line_of_[(address - address_) / 4]; }

    Chain const& chain(std::uint32_t number) const { return chains_[number]; }
    Line const& line(std::uint32_t number) const { return lines_[number]; }

    /// The outermost function of an instruction, which the linker knows.
    std::uint32_t function_of(std::uint32_t address) const { return chains_[chain_of(address)].front(); }

private:
    void read_symbols(FirmwareProgram const& program);
    void read_debug_information(FirmwareProgram const& program);
    std::uint32_t function_number(std::string_view name);
    std::uint32_t chain_number(Chain const& chain);
    std::uint32_t line_number(std::string const& file, int line);

    std::uint32_t address_;
    std::vector<std::uint32_t> chain_of_;  // of each word
    std::vector<std::uint32_t> line_of_;
    std::vector<bool> is_entry_;
    std::vector<std::string> functions_;
    std::vector<Chain> chains_;
    std::vector<Line> lines_;
    std::map<std::string, std::uint32_t, std::less<>> number_of_function_;
    std::map<Chain, std::uint32_t> number_of_chain_;
    std::map<std::pair<std::string, int>, std::uint32_t> number_of_line_;

    friend class DebugReader;
};

}  // namespace pogosim
