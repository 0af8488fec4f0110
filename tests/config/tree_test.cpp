#include "config/tree.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

Node read(std::string const& text) {
    Folder const folder;
    Folder::write("x.yaml", text);
    return read_yaml_file("x.yaml");
}

std::string scalar_at(Node const& root, std::string_view path) {
    Node const* node = find_path(root, path);
    return node == nullptr ? "(absent)" : node->scalar;
}

std::string set(std::string const& text, std::string const& assignment) {
    Node root = read(text);
    apply_override(root, assignment);
    return to_yaml(root);
}

std::string set_error(std::string const& text, std::string const& assignment) {
    Node root = read(text);
    return error_of([&] { apply_override(root, assignment); });
}

}  // namespace

TEST(Tree, EveryValueKnowsItsFileAndLine) {
    Node const root = read("a: 1\nb:\n  c: [x,\n      y]\n  d:\n    - e\n");
    EXPECT_EQ(root.find("a")->where(), "x.yaml:1");
    EXPECT_EQ(root.find("b")->where(), "x.yaml:2");
    EXPECT_EQ(find_path(root, "b.c")->where(), "x.yaml:3");
    EXPECT_EQ(find_path(root, "b.c.1")->where(), "x.yaml:4");
    EXPECT_EQ(find_path(root, "b.d.0")->where(), "x.yaml:6");
}

TEST(Tree, DottedPathWalksMapsAndLists) {
    Node const root = read("p: {k: 5, list: [7, {deep: 8}]}\n");
    EXPECT_EQ(scalar_at(root, "p.k"), "5");
    EXPECT_EQ(scalar_at(root, "p.list.0"), "7");
    EXPECT_EQ(scalar_at(root, "p.list.1.deep"), "8");
    EXPECT_EQ(find_path(root, "p.none"), nullptr);
    EXPECT_EQ(find_path(root, "p.k.further"), nullptr);
    EXPECT_EQ(find_path(root, "p.list.2"), nullptr);
    EXPECT_EQ(find_path(root, "p.list.-1"), nullptr);
    EXPECT_EQ(find_path(root, "p.list.x"), nullptr);
    EXPECT_EQ(find_path(root, ""), nullptr);
    EXPECT_EQ(find_path(root, "p."), nullptr);
    EXPECT_EQ(find_path(Node{}, "a.b"), nullptr);
}

TEST(Tree, AnExactDottedKeyWinsAndABackslashKeepsADot) {
    Node const root = read("p.k: exact\np: {k: walked, a.b: {c: dotted}}\n");
    EXPECT_EQ(scalar_at(root, "p.k"), "exact");
    EXPECT_EQ(scalar_at(root, R"(p.a\.b.c)"), "dotted");
}

TEST(Tree, SetReplacesValuesAndMakesMapsOnTheWay) {
    EXPECT_EQ(set("a: 1\n", "a=2"), "a: 2\n");
    EXPECT_EQ(set("a: 1\n", "b.c.d=x"), "a: 1\nb:\n  c:\n    d: x\n");
    EXPECT_EQ(set("a:\n", "a.b=1"), "a:\n  b: 1\n");
    EXPECT_EQ(set("a: [1, 2]\n", "a.1=3"), "a:\n  - 1\n  - 3\n");
    EXPECT_EQ(set("a: 1\n", R"(b\.c=2)"), "a: 1\nb.c: 2\n");
    EXPECT_EQ(set("a.b: 1\n", "a.b=2"), "a.b: 2\n");
    EXPECT_EQ(set("a: 1\n", "a={x: [1, 2]}"), "a:\n  x:\n    - 1\n    - 2\n");
    EXPECT_EQ(set("a: 1\n", "a=null"), "a: null\n");
    EXPECT_EQ(set("a: 1\n", "a=b=c"), "a: \"b=c\"\n");
}

TEST(Tree, WhatWasSetSaysSo) {
    Node root = read("a: 1\n");
    apply_override(root, "b.c=[1]");
    EXPECT_EQ(find_path(root, "b")->where(), "--set");
    EXPECT_EQ(find_path(root, "b.c.0")->where(), "--set");
}

TEST(Tree, SetThatMakesNoSenseIsRefused) {
    EXPECT_EQ(set_error("a: 1\n", "a"), "--set 'a': expected key.path=value");
    EXPECT_EQ(set_error("a: 1\n", "a="), "--set 'a=': nothing stands behind '='; for the default, write a=null");
    EXPECT_EQ(set_error("a: 1\n", "=1"), "--set '=1': a name in the key path is empty");
    EXPECT_EQ(set_error("a: 1\n", "b..c=1"), "--set 'b..c=1': a name in the key path is empty");
    EXPECT_EQ(set_error("a: 1\n", "b.=1"), "--set 'b.=1': a name in the key path is empty");
    EXPECT_EQ(set_error("a: 1\n", "a.b=1"), "--set 'a.b=1': 'b' would be inside the single value '1' (x.yaml:1)");
    EXPECT_EQ(set_error("a: [1]\n", "a.1=1"),
              "--set 'a.1=1': '1' is not an index of the list of length 1 at x.yaml:1; the first one is 0");
    EXPECT_EQ(set_error("a: 1\n", "a=[1"),
              "--set 'a=[1':1: not valid YAML: end of sequence flow not found; is a ']' or a comma missing?");
    std::string path = "a";
    for (int i = 0; i < 100000; ++i) {
        path += ".a";
    }
    EXPECT_EQ(set_error("b: 1\n", path + "=1"), "--set: the key path has more than 100 names");
    EXPECT_EQ(set_error("b: 1\n", "b=" + std::string(99, '[') + std::string(99, ']')), "no error");
    EXPECT_EQ(set_error("b: 1\n", "b.c=" + std::string(100, '[') + std::string(100, ']')).substr(0, 6), "--set ");
}
