#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "base/random.hpp"
#include "config/tree.hpp"
#include "config_file.hpp"

using namespace pogosim;

namespace {

std::string const kPieces[] = {"a",
                               "Z",
                               "0",
                               "7",
                               ".",
                               "-",
                               "_",
                               " ",
                               "  ",
                               ":",
                               ": ",
                               "#",
                               " #",
                               "\n",
                               "\n\n",
                               "\t",
                               "\r",
                               "\"",
                               "'",
                               "\\",
                               "{",
                               "}",
                               "[",
                               "]",
                               ",",
                               "&",
                               "*",
                               "!",
                               "|",
                               ">",
                               "%",
                               "@",
                               "`",
                               "? ",
                               "- ",
                               "<<",
                               "=",
                               "\x01",
                               "\x1b",
                               "\x7f",
                               "\xC2\x85",
                               "\xC2\xA0",
                               "\xC3\xA9",
                               "\xE2\x80\xA8",
                               "\xEF\xBB\xBF",
                               "\xEF\xBF\xBE",
                               "\xF0\x9F\xA4\x96",
                               "e6",
                               "null",
                               "true",
                               "---",
                               "...",
                               "\xEE\x80\x80",
                               "\xED\x9F\xBF",
                               "/"};
std::string const kPlain[] = {"1",    "-3.5", "1.0e6",        "0x1F", ".nan", "-.inf",
                              "true", "No",   "frames/f.png", "text", "1e3"};

std::string random_text(RandomStream& random) {
    std::string text;
    for (std::uint32_t i = random.below(9); i > 0; --i) {
        text += kPieces[random.below(std::size(kPieces))];
    }
    return text;
}

Node random_tree(RandomStream& random, int depth) {
    Node node;
    switch (random.below(depth > 0 ? 5 : 3)) {
        case 0:
            return node;
        case 1:
            node.kind = Node::Kind::scalar;
            node.scalar = kPlain[random.below(std::size(kPlain))];
            return node;
        case 2:
            node.kind = Node::Kind::scalar;
            node.scalar = random_text(random);
            node.quoted = true;
            return node;
        case 3:
            node.kind = Node::Kind::sequence;
            for (std::uint32_t i = random.below(4); i > 0; --i) {
                node.items.push_back(random_tree(random, depth - 1));
            }
            return node;
        default:
            node.kind = Node::Kind::map;
            for (std::uint32_t i = random.below(5); i > 0; --i) {
                std::string key = random_text(random);
                if (node.find(key) == nullptr) {
                    node.entries.emplace_back(std::move(key), random_tree(random, depth - 1));
                }
            }
            return node;
    }
}

void expect_same(Node const& a, Node const& b, std::string const& yaml) {
    ASSERT_EQ(a.kind, b.kind) << yaml;
    ASSERT_EQ(a.scalar, b.scalar) << yaml;
    ASSERT_EQ(a.quoted, b.quoted) << yaml;
    ASSERT_EQ(a.items.size(), b.items.size()) << yaml;
    ASSERT_EQ(a.entries.size(), b.entries.size()) << yaml;
    for (std::size_t i = 0; i < a.items.size(); ++i) {
        expect_same(a.items[i], b.items[i], yaml);
    }
    for (std::size_t i = 0; i < a.entries.size(); ++i) {
        ASSERT_EQ(a.entries[i].key, b.entries[i].key) << yaml;
        expect_same(a.entries[i].value, b.entries[i].value, yaml);
    }
}

std::string rewritten(std::string const& text) {
    return to_yaml(parse_yaml(text, "x.yaml"));
}

}  // namespace

TEST(WriteYaml, ReadingWhatWasWrittenGivesTheSameTree) {
    RandomStream random(1, 0);
    for (int i = 0; i < 2000; ++i) {
        Node const tree = random_tree(random, 5);
        std::string const yaml = to_yaml(tree);
        expect_same(tree, parse_yaml(yaml, "x.yaml"), yaml);
        ASSERT_FALSE(HasFatalFailure());
    }
}

TEST(WriteYaml, NumbersStayAsTheyWereWritten) {
    EXPECT_EQ(rewritten("a: 1.0e6\nb: 0x1F\nc: -.inf\nd: 007\n"), "a: 1.0e6\nb: 0x1F\nc: -.inf\nd: 007\n");
}

TEST(WriteYaml, QuotedTextsStayTexts) {
    EXPECT_EQ(rewritten("a: '1.0e6'\nb: \"true\"\nc: ''\nd: 'null'\n"),
              "a: \"1.0e6\"\nb: \"true\"\nc: \"\"\nd: \"null\"\n");
}

TEST(WriteYaml, TextsThatNeedQuotesGetThem) {
    EXPECT_EQ(rewritten("a: two words\nb: x#y\n'c: d': '-'\n"), "a: \"two words\"\nb: \"x#y\"\n\"c: d\": \"-\"\n");
}

TEST(WriteYaml, BlockTextsKeepTheirLines) {
    EXPECT_EQ(rewritten("a: |\n  one\n  two\nb: >\n  one\n  two\n"), "a: \"one\\ntwo\\n\"\nb: \"one two\\n\"\n");
}

TEST(WriteYaml, EmptyMapsAndListsStay) {
    EXPECT_EQ(rewritten("a: {}\nb: []\nc: [[], {}]\n"), "a: {}\nb: []\nc:\n  - []\n  - {}\n");
    EXPECT_EQ(to_yaml(Node{}), "null\n");
}

TEST(WriteYaml, KeysLongerThanYamlsLimitAreWrittenToo) {
    std::string const key(3000, 'k');
    Node root;
    root.kind = Node::Kind::map;
    root.entries.emplace_back(key, parse_yaml("{a: 1}", "x.yaml"));
    EXPECT_EQ(find_path(parse_yaml(to_yaml(root), "x.yaml"), key + ".a")->scalar, "1");
}

TEST(WriteYaml, BytesThatAreNotTextBecomeReplacementCharacters) {
    for (std::string const malformed : {"\xC3", "\xE2\x82", "\xF0\x9F\xA4", "\xFF"}) {
        Node map;
        map.kind = Node::Kind::map;
        Node text;
        text.kind = Node::Kind::scalar;
        text.scalar = "a" + malformed;
        map.entries.emplace_back("key", text);
        std::string marks;
        for (std::size_t i = 0; i < malformed.size(); ++i) {
            marks += "\\ufffd";
        }
        EXPECT_EQ(to_yaml(map), "key: \"a" + marks + "\"\n");
    }
}
