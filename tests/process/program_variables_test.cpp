// What the window shows of a program's variables: names, types and values, from its debug information.
#include "process/program_variables.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "process/variable_text.hpp"

namespace pogosim {
namespace {

/// tests/programs/variables.c or class_variables.cpp in memory.
class Program {
public:
    explicit Program(char const* file) : library_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
        EXPECT_NE(library_, nullptr) << dlerror();
        Dl_info info = {};
        dladdr(dlsym(library_, "example"), &info);
        image.file = file;
        image.load_address = reinterpret_cast<std::uintptr_t>(info.dli_fbase);
        image.user_data_bytes = *static_cast<std::size_t const*>(dlsym(library_, "size_of_data"));
    }
    ~Program() { dlclose(library_); }
    Program(Program const&) = delete;
    Program& operator=(Program const&) = delete;

    std::span<std::byte const> example() const {
        return {static_cast<std::byte const*>(dlsym(library_, "example")), image.user_data_bytes};
    }

    std::string text_of(ProgramVariables::Variable const& variable) const {
        auto const* const place = reinterpret_cast<std::byte const*>(image.load_address + variable.address);
        return value_text(*variable.type, {place, variable.type->bytes});
    }

    ProgramImage image;

private:
    void* library_;
};

#ifdef POGOSIM_TEST_VARIABLES_5

class Variables : public ::testing::TestWithParam<char const*> {};

INSTANTIATE_TEST_SUITE_P(Dwarf, Variables, ::testing::Values(POGOSIM_TEST_VARIABLES_4, POGOSIM_TEST_VARIABLES_5));

TEST_P(Variables, UserDataHaveALineForEachMember) {
    Program const program(GetParam());
    ProgramVariables const variables = variables_of(program.image);
    ASSERT_NE(variables.user_data, nullptr) << variables.why_unknown;
    NamedTexts texts;
    add_texts("", *variables.user_data, program.example(), texts);
    NamedTexts const expected{{"age", "200"},
                              {"balance", "-300"},
                              {"is_happy", "true"},
                              {"state", "TURNING"},
                              {"place.x", "0.5"},
                              {"place.y", "-2.25"},
                              {"history", "1, 2, 3, 4, 5, 6, 7, 8, ... (12)"},
                              {"table", "[-1, 2, -3], [4, -5, 6]"},
                              {"name", "\"ab\\n\""},
                              {"corners", "{x: 1, y: 2}, {x: 3, y: 4}"},
                              {"nothing", "null"},
                              {"low", "5"},
                              {"high", "-7"},
                              {"raw.word", "16909060"},
                              {"raw.bytes", "4, 3, 2, 1"},
                              {"inner", "-9000000000"}};
    EXPECT_EQ(texts, expected);
}

TEST_P(Variables, GlobalsThatRobotsMayOwnAreFoundByName) {
    Program const program(GetParam());
    std::map<std::string, std::string> values;
    for (ProgramVariables::Variable const& variable : variables_of(program.image).own) {
        values[variable.name] = program.text_of(variable);
    }
    EXPECT_EQ(values.at("counter"), "41");
    // Two have the same name.
    EXPECT_EQ(values.at("next: twice"), "10");
    EXPECT_EQ(values.at("variables.c: twice"), "1");
    EXPECT_FALSE(values.contains("constant"));
    EXPECT_FALSE(values.contains("mydata"));
}

TEST_P(Variables, UserDataOfAnotherSizeAreOfAnotherProgram) {
    Program program(GetParam());
    program.image.user_data_bytes += 1;
    EXPECT_EQ(variables_of(program.image).user_data, nullptr);
}

TEST(Variables, MembersOfBaseClassesCountAndLibraryClassesAreOpaque) {
    Program const program(POGOSIM_TEST_CLASS_VARIABLES);
    ProgramVariables const variables = variables_of(program.image);
    ASSERT_NE(variables.user_data, nullptr) << variables.why_unknown;
    NamedTexts texts;
    add_texts("", *variables.user_data, program.example(), texts);
    // Where a virtual base class is, is only known at run time.
    NamedTexts const expected{{"depth", "0.5"},       {"id", "3"},        {"count", "9"}, {"numbers", "4, 5"},
                              {"list", "(24 bytes)"}, {"part.own", "12"}, {"low", "5"}};
    EXPECT_EQ(texts, expected);
}

TEST(Variables, ProgramWithoutDebugInformationSaysHowToGetSome) {
    Program const program(POGOSIM_TEST_VARIABLES_WITHOUT);
    ProgramVariables const variables = variables_of(program.image);
    EXPECT_EQ(variables.user_data, nullptr);
    EXPECT_TRUE(variables.own.empty());
    EXPECT_EQ(variables.why_unknown, "compile the program with -g to see its variables");
}

#endif

TEST(VariableText, UnknownNumberOfAnEnumerationIsShownAsItIs) {
    VariableType const type{
        .kind = VariableType::Kind::enumeration, .bytes = 1, .constants = {{0, "RED"}, {255, "BLUE"}}};
    std::byte bytes[] = {std::byte{255}};
    EXPECT_EQ(value_text(type, bytes), "BLUE");
    bytes[0] = std::byte{3};
    EXPECT_EQ(value_text(type, bytes), "3");
}

TEST(VariableText, BytesThatAreMissingAreNotRead) {
    VariableType const type{.kind = VariableType::Kind::unsigned_number, .bytes = 4};
    std::byte const bytes[] = {std::byte{255}};
    EXPECT_EQ(value_text(type, bytes), "?");
}

TEST(VariableText, HugeArraysAreCut) {
    auto const row =
        std::make_shared<VariableType const>(VariableType{.kind = VariableType::Kind::array,
                                                          .bytes = 1000,
                                                          .element = std::make_shared<VariableType const>(VariableType{
                                                              .kind = VariableType::Kind::unsigned_number, .bytes = 1}),
                                                          .count = 1000});
    VariableType const type{.kind = VariableType::Kind::array, .bytes = 1000000, .element = row, .count = 1000};
    std::vector<std::byte> const bytes(1000000);
    std::string const text = value_text(type, bytes);
    EXPECT_LT(text.size(), 400U);
    EXPECT_TRUE(text.ends_with("... (1000)"));
}

}  // namespace
}  // namespace pogosim
