// Reading the debug information of a program: what is found, and how much work it is.
#include <dlfcn.h>
#include <elfutils/libdw.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "debug_info/debug_info.hpp"
#include "debug_info/program_file.hpp"

namespace {

struct Work {
    long entries = 0;   // read one after the other
    long searches = 0;  // of the scopes of an entry, from the beginning of its unit
};

Work work;

template <class Function>
Function* next(char const* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// What the code under test calls in place of libdw's functions.
extern "C" int dwarf_siblingof(Dwarf_Die* entry, Dwarf_Die* sibling) {
    static auto* const original = next<int(Dwarf_Die*, Dwarf_Die*)>("dwarf_siblingof");
    ++work.entries;
    return original(entry, sibling);
}

extern "C" int dwarf_getscopes_die(Dwarf_Die* entry, Dwarf_Die** scopes) {
    static auto* const original = next<int(Dwarf_Die*, Dwarf_Die**)>("dwarf_getscopes_die");
    ++work.searches;
    return original(entry, scopes);
}

namespace shared_state {
namespace {

DebugInfo read(char const* program) {
    work = {};
    return read_debug_info(ProgramFile(program));
}

TEST(DebugInformation, OfTwiceAsManyFunctionsIsTwiceTheWork) {
    read(POGOSIM_TEST_FUNCTIONS_100);
    Work const hundred = work;
    read(POGOSIM_TEST_FUNCTIONS_200);
    EXPECT_GT(hundred.entries, 1000);
    EXPECT_LT(work.entries, 2.2 * static_cast<double>(hundred.entries));
    EXPECT_EQ(work.searches, 0);
}

TEST(DebugInformation, TellsTheFunctionAndTheClassOfEachVariable) {
    std::set<std::string> classes;
    std::set<Scope> functions;
    for (Object const& object : read(POGOSIM_TEST_FUNCTIONS_100).objects) {
        EXPECT_EQ(object.bytes, sizeof(int));
        if (object.function.empty()) {
            EXPECT_EQ(object.name, "calls");
            EXPECT_EQ(object.line, 6);
            classes.insert(object.qualifier);
        } else {
            EXPECT_EQ(object.name, "steps");
            EXPECT_EQ(object.line, 9);
            EXPECT_EQ(object.function, "step");
            functions.insert(object.function_scope);
        }
    }
    EXPECT_EQ(classes.size(), 100U);
    EXPECT_TRUE(classes.contains("swarm::Part<100>::"));
    EXPECT_EQ(functions.size(), 100U);
}

}  // namespace
}  // namespace shared_state
