#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "config/tree.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

Node read(std::string const& text) {
    Folder const folder;
    Folder::write("x.yaml", text);
    return read_yaml_file("x.yaml");
}

std::string rewritten(std::string const& text) {
    return to_yaml(read(text));
}

std::string read_error(std::string const& text) {
    return error_of([&] { read(text); });
}

}  // namespace

TEST(ReadYaml, KeepsTheOrderOfKeys) {
    EXPECT_EQ(rewritten("z: 1\na: 2\nm: 3\n"), "z: 1\na: 2\nm: 3\n");
}

TEST(ReadYaml, TellsNullFromTextsThatLookLikeIt) {
    Node const root = read("a:\nb: ~\nc: null\nd: ''\ne: 'null'\nf: \"~\"\n");
    for (char const* key : {"a", "b", "c"}) {
        EXPECT_EQ(root.find(key)->kind, Node::Kind::null) << key;
    }
    for (char const* key : {"d", "e", "f"}) {
        EXPECT_EQ(root.find(key)->kind, Node::Kind::scalar) << key;
        EXPECT_TRUE(root.find(key)->quoted) << key;
    }
}

TEST(ReadYaml, TextTagMakesATextOfANumber) {
    EXPECT_EQ(rewritten("a: !!str 12\n"), "a: \"12\"\n");
}

TEST(ReadYaml, AliasesAreCopiedWithTheLineOfTheAlias) {
    Node const root = read("base: &b {x: 1}\n\nuse: *b\n");
    EXPECT_EQ(find_path(root, "use.x")->scalar, "1");
    EXPECT_EQ(find_path(root, "use")->line, 3);
}

TEST(ReadYaml, MergedEntriesComeFirstAndAreReplacedByOwnOnes) {
    EXPECT_EQ(rewritten("b: &b {x: 1, y: 2}\nu:\n  z: 3\n  x: 4\n  <<: *b\n"),
              "b:\n  x: 1\n  y: 2\nu:\n  x: 4\n  y: 2\n  z: 3\n");
}

TEST(ReadYaml, EarlierMergedMapsWin) {
    EXPECT_EQ(rewritten("u: {<<: [{x: 1}, {x: 2, y: 3}]}\n"), "u:\n  x: 1\n  y: 3\n");
}

TEST(ReadYaml, QuotedMergeKeyIsAnOrdinaryKey) {
    EXPECT_EQ(rewritten("u: {'<<': 1}\n"), "u:\n  \"<<\": 1\n");
}

TEST(ReadYaml, MergeOfSomethingElseThanMapsIsRefused) {
    EXPECT_EQ(read_error("a: 1\nu:\n  <<: 5\n"), "x.yaml:3: the merge key '<<' takes a map or a list of maps");
    EXPECT_EQ(read_error("u: {<<: [{x: 1}, 2]}\n"), "x.yaml:1: the merge key '<<' takes a map or a list of maps");
}

TEST(ReadYaml, DuplicateKeyWarnsWithBothLinesAndTheLastWins) {
    Warnings const warnings;
    EXPECT_EQ(rewritten("a: 1\nb: 2\na: 3\n"), "a: 3\nb: 2\n");
    EXPECT_EQ(warnings.text(), "x.yaml:3: duplicate key 'a', first on line 1; the last one is used\n");
}

TEST(ReadYaml, OnlyTheFirstDocumentIsUsed) {
    Warnings const warnings;
    EXPECT_EQ(rewritten("a: 1\n---\nb: 2\n"), "a: 1\n");
    EXPECT_EQ(warnings.text(), "x.yaml:2: a second document starts here; only the first one is used\n");
}

TEST(ReadYaml, ByteOrderMarkAndWindowsLineEndsAreFine) {
    EXPECT_EQ(rewritten("\xEF\xBB\xBF"
                        "a: 1\r\nb: x\r\n"),
              "a: 1\nb: x\n");
}

TEST(ReadYaml, MissingFileIsNamedWithThePlaceLookedAt) {
    Folder const folder;
    EXPECT_EQ(error_of([] { read_yaml_file("conf/none.yaml"); }),
              "cannot read the configuration 'conf/none.yaml': No such file or directory (looked for " +
                  (std::filesystem::current_path() / "conf/none.yaml").string() + ")");
    EXPECT_EQ(error_of([] { read_yaml_file("."); }), "'.' is a folder; expected a YAML file");
    EXPECT_NE(error_of([] { read_yaml_file(""); }).find("No such file or directory"), std::string::npos);
}

TEST(ReadYaml, EndlessFileIsNoConfiguration) {
    EXPECT_EQ(error_of([] { read_yaml_file("/dev/zero"); }),
              "'/dev/zero' is larger than 64 MB; this is not a configuration");
}

TEST(ReadYaml, EmptyFileSaysWhatIsNeeded) {
    for (char const* text : {"", "\n\n", "# nothing\n", "---\n", "~\n"}) {
        EXPECT_EQ(read_error(text),
                  "x.yaml: the file is empty; expected a map of keys, in a configuration with at least 'objects'")
            << text;
    }
}

TEST(ReadYaml, TopLevelHasToBeAMap) {
    EXPECT_EQ(read_error("\n- a\n"), "x.yaml:2: expected a map of keys at the top level, found a list");
    EXPECT_EQ(read_error("hello\n"), "x.yaml:1: expected a map of keys at the top level, found a single value");
}

TEST(ReadYaml, SyntaxErrorsNameTheirLine) {
    EXPECT_EQ(read_error("a: 1\nb: [1, 2\nc: 3\n").substr(0, 9), "x.yaml:3:");
    EXPECT_EQ(read_error("a: 1\nb: {x: 1\n").substr(0, 9), "x.yaml:2:");
    for (char const* text : {"a: 1\n\tb: 2\n", "a:\n\tb: 2\n", "a:\n  \tb: {c: 1}\n"}) {
        EXPECT_EQ(read_error(text), "x.yaml:2: not valid YAML: this line is indented with a tab; use spaces") << text;
    }
    for (char const* text : {"z: 0\na: 'open\n", "z: 0\na: \"open\nb: 2\n", "z: 0\n'a", "z: 0\na: \"x\\"}) {
        EXPECT_EQ(read_error(text),
                  "x.yaml:2: not valid YAML: the string that starts here does not end; is its closing quote missing?")
            << text;
    }
    EXPECT_EQ(read_error("{a: 1}\nb: 2\n"), "x.yaml:2: not valid YAML: 'b: 2' is not part of the structure above it");
    // yaml-cpp 0.8 adds the anchor's name.
    std::string const anchor = read_error("a: *nobody\n");
    EXPECT_TRUE(anchor.starts_with("x.yaml:1: not valid YAML: the referenced anchor is not defined")) << anchor;
    std::string const keys =
        "; the keys of a map must start in the same column, each followed by a colon and a space, and a string "
        "containing ': ' needs quotes";
    EXPECT_EQ(read_error("a: b: c\n"), "x.yaml:1: not valid YAML: illegal map value" + keys);
    EXPECT_EQ(read_error("a: 1\n  b: 2\n"), "x.yaml:2: not valid YAML: illegal map value" + keys);
    EXPECT_EQ(read_error("a:\n    b: 2\n  c: 3\n"), "x.yaml:3: not valid YAML: end of map not found" + keys);
    EXPECT_EQ(read_error("a: {b: 1\n"),
              "x.yaml:1: not valid YAML: end of map flow not found; is a '}' or a comma missing?");
    EXPECT_EQ(read_error("? [1]\n: 2\n"), "x.yaml:1: the key of a map must be a plain string");
    EXPECT_EQ(read_error("a: {~: 1}\n"), "x.yaml:1: the key of a map must be a plain string");
}

TEST(ReadYaml, BytesThatAreNoTextAreRefusedWithTheirLine) {
    EXPECT_EQ(read_error("a: 1\nb: \xFF\n"), "x.yaml:2: byte 0xff is not valid here; a configuration is UTF-8 text");
    EXPECT_EQ(read_error(std::string("a: \0\n", 5)),
              "x.yaml:1: byte 0x00 is not valid here; a configuration is UTF-8 text");
    EXPECT_EQ(read_error("a: \x04\n"), "x.yaml:1: byte 0x04 is not valid here; a configuration is UTF-8 text");
    EXPECT_EQ(read_error("\x7F"
                         "ELF\x02\x01")
                  .substr(0, 9),
              "x.yaml:1:");
    EXPECT_EQ(read_error("a: \"\\0\"\n"),
              "x.yaml:1: a string contains a zero byte (\\0), and no text of a configuration can");
    // Overlong, surrogate, beyond Unicode, cut short.
    for (char const* bytes : {"\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF0\x80\x80\xAF", "\xF4\x90\x80\x80",
                              "\xF8\x88\x80\x80\x80", "\xE2\x82", "\x80"}) {
        EXPECT_EQ(read_error(std::string("a: ") + bytes).substr(0, 15), "x.yaml:1: byte ") << bytes;
    }
    EXPECT_EQ(rewritten("a: \"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\xA4\x96\"\n"),
              "a: \"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\xA4\x96\"\n");
}

TEST(ReadYaml, AliasInsideItsOwnValueIsRefused) {
    EXPECT_EQ(read_error("a: &x\n  b: *x\n"), "x.yaml:2: this alias (*name) is inside the value it refers to");
    EXPECT_EQ(read_error("a: &x [1, *x]\n"), "x.yaml:1: this alias (*name) is inside the value it refers to");
}

TEST(ReadYaml, AliasesThatMultiplyEndInAnErrorNotInMemory) {
    std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 30; ++i) {
        std::string const before = "*a" + std::to_string(i - 1);
        text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
        for (int k = 0; k < 10; ++k) {
            text += before + ", ";
        }
        text += "]\n";
    }
    EXPECT_NE(read_error(text).find("more than 1000000 values once aliases are followed"), std::string::npos);
}

TEST(ReadYaml, DeepNestingIsRefused) {
    auto const nested = [](std::size_t depth) { return "a: " + std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_EQ(read_error(nested(99)), "no error");
    EXPECT_EQ(read_error(nested(100)), "x.yaml:1: nested deeper than 100 levels once aliases are followed");
    EXPECT_EQ(read_error(nested(100000)), "x.yaml:1: nested deeper than 100 levels once aliases are followed");
    std::string text = "a0: &a0 [x]\n";
    for (int i = 1; i < 200; ++i) {
        text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
    }
    EXPECT_NE(read_error(text).find("nested deeper than 100 levels"), std::string::npos);
}
