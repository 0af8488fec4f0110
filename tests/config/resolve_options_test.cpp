#include <gtest/gtest.h>

#include <string>

#include "base/problems.hpp"
#include "config/tree.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

std::string resolved(std::string const& text) {
    Problems problems;
    Node const root = resolve_options(parse_yaml(text, "x.yaml"), problems);
    problems.throw_if_any();
    return to_yaml(root);
}

}  // namespace

TEST(ResolveOptions, PlainValuesStay) {
    EXPECT_EQ(resolved("a: 1\nb: [1, {c: 2}]\n"), "a: 1\nb:\n  - 1\n  - c: 2\n");
}

TEST(ResolveOptions, DefaultOptionStandsForTheWholeOffer) {
    EXPECT_EQ(resolved("a: {batch_options: [1, 2], default_option: 3}\n"), "a: 3\n");
    EXPECT_EQ(resolved("a: {batch_options_range: {start: 0, stop: 9, step: 1}, default_option: 4}\n"), "a: 4\n");
    EXPECT_EQ(resolved("a: {optimization_domain: {type: int, min: 0, max: 9, init: 6}, default_option: 5}\n"),
              "a: 5\n");
    EXPECT_EQ(resolved("a: {default_option: {b: [1]}}\n"), "a:\n  b:\n    - 1\n");
}

TEST(ResolveOptions, OptionsAreFoundAtAnyDepth) {
    EXPECT_EQ(resolved("l: [{default_option: 1, batch_options: [1]}, {m: {n: {default_option: 2}}}]\n"),
              "l:\n  - 1\n  - m:\n      n: 2\n");
    EXPECT_EQ(resolved("a: {default_option: {default_option: 7}}\n"), "a: 7\n");
}

TEST(ResolveOptions, OfferWithoutDefaultLeavesTheKeysOwnDefault) {
    EXPECT_EQ(resolved("a: {batch_options: [1, 2]}\n"), "a: null\n");
    EXPECT_EQ(resolved("a: {batch_options_range: {start: 0, stop: 9, step: 1}}\n"), "a: null\n");
    EXPECT_EQ(resolved("a: {optimization_domain: {type: int, min: 0, max: 9}}\n"), "a: null\n");
}

TEST(ResolveOptions, OptimisationStartsServesWithoutDefaultOption) {
    EXPECT_EQ(resolved("a: {optimization_domain: {type: int, min: 0, max: 9, init: 6}}\n"), "a: 6\n");
}

TEST(ResolveOptions, DefaultAlternativeIsLaidOverItsSiblings) {
    EXPECT_EQ(resolved("a: 1\nm: {x: 1, y: 2}\nbatch_hierarchical_options:\n"
                       "  name: scene\n  default: {a: 9, m: {y: 8, z: 7}}\n  other: {a: 5}\n"),
              "a: 9\nm:\n  x: 1\n  y: 8\n  z: 7\n");
}

TEST(ResolveOptions, AlternativesMayHoldOptionsAndAlternatives) {
    EXPECT_EQ(resolved("o: {k: {batch_options: [1, 2], default_option: 1}, batch_hierarchical_options: {default: "
                       "{k: {default_option: 3}, batch_hierarchical_options: {default: {j: 4}}}}}\n"),
              "o:\n  k: 3\n  j: 4\n");
}

TEST(ResolveOptions, AlternativesWithoutADefaultAreIgnoredWithAWarning) {
    Warnings const warnings;
    EXPECT_EQ(resolved("a: 1\nbatch_hierarchical_options: {one: {a: 2}}\n"), "a: 1\n");
    EXPECT_EQ(resolved("a: 1\nbatch_hierarchical_options: {default: 3}\n"), "a: 1\n");
    EXPECT_EQ(resolved("a: 1\nbatch_hierarchical_options: [x]\n"), "a: 1\n");
    EXPECT_EQ(warnings.lines().size(), 3U);
    EXPECT_EQ(
        warnings.lines().front(),
        "x.yaml:2: 'batch_hierarchical_options' has no map 'default'; a single run uses none of its alternatives");
}

TEST(ResolveOptions, TheChosenValueKeepsItsOwnLine) {
    Problems problems;
    Node const root =
        resolve_options(parse_yaml("a:\n  batch_options: [1]\n  default_option: 1\n", "x.yaml"), problems);
    EXPECT_EQ(root.find("a")->where(), "x.yaml:3");
}
