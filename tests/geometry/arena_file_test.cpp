#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "base/random.hpp"
#include "geometry/arena.hpp"
#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

std::string const kSquare = "0,0\n10,0\n10,10\n0,10\n";

/// A file of the given text, in a folder of its own that goes away with it.
class ArenaFile : public testing::Test {
protected:
    ArenaOutline read(std::string const& text) {
        std::ofstream(path_, std::ios::binary) << text;
        return read_arena_file(path_);
    }

    /// The message without the folder; empty when the text is accepted.
    std::string error_of(std::string const& text) {
        std::ofstream(path_, std::ios::binary) << text;
        return error_of_path(path_);
    }

    std::string error_of_path(fs::path const& path) const {
        try {
            read_arena_file(path);
        } catch (ConfigError const& error) {
            std::string const message = error.what();
            std::string const prefix = folder_.path().string() + "/";
            return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
        }
        return "";
    }

    TemporaryFolder folder_;
    fs::path path_{folder_ / "arena.csv"};
};

Polygon const kSquareCorners{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

TEST_F(ArenaFile, FirstPolygonIsTheOuterOneAndBlankLinesStartHoles) {
    ArenaOutline const outline = read(kSquare + "\n2,2\n3,2\n3,3\n\n5,5\n7,5\n7,7\n5,7\n");
    ASSERT_EQ(outline.polygons.size(), 3U);
    EXPECT_EQ(outline.polygons[0], kSquareCorners);
    EXPECT_EQ(outline.polygons[1], (Polygon{{2, 2}, {3, 2}, {3, 3}}));
    EXPECT_EQ(outline.source, path_.string());
}

TEST_F(ArenaFile, CommentSaysThatAnArenaIsPeriodic) {
    EXPECT_FALSE(read(kSquare).periodic);
    EXPECT_FALSE(read("# periodic or not\n" + kSquare).periodic);
    for (char const* line : {"# boundary_condition: periodic\n", "#boundary_condition:periodic\r\n"}) {
        EXPECT_TRUE(read(line + kSquare).periodic) << line;
        EXPECT_TRUE(read(kSquare + line).periodic) << line;
    }
    EXPECT_EQ(
        error_of("# boundary_condition: soft\n" + kSquare),
        "arena.csv:1: expected 'boundary_condition: periodic', found 'boundary_condition: soft'. Solid walls need no "
        "such line");
}

TEST_F(ArenaFile, EmptyFilesAndFilesOfCommentsHaveNoPolygon) {
    for (char const* text :
         {"", "\n\n  \n\t\r\n", "# nothing\n\n# here", "\xEF\xBB\xBF", "# boundary_condition: periodic\n"}) {
        EXPECT_EQ(
            error_of(text),
            "arena.csv: the file has no polygon; expected the corners of an arena, one 'x,y' a line. For a square "
            "without walls use 'arena_file: arenas/square.csv' and 'boundary_condition: periodic'");
    }
}

TEST_F(ArenaFile, EverySpellingOfTheSameSquareGivesTheSamePolygon) {
    std::string const texts[] = {
        "0,0\r\n10,0\r\n10,10\r\n0,10\r\n",                 // Windows
        "0,0\r10,0\r10,10\r0,10",                           // old Macintosh
        "\xEF\xBB\xBF" + kSquare,                           // byte order mark
        "0,0\n10,0\n10,10\n0,10",                           // no line end at the end
        kSquare + "0,0\n",                                  // closed
        kSquare + "0,0\n0,0\n",                             // closed twice
        "0,0\n0,0\n10,0\n10,0\n10,0\n10,10\n0,10\n",        // repeated corners
        "\n\n\n" + kSquare + "\n \n\t\n",                   // blank lines around
        " 0 , 0 \n\t10\t,\t0\n10 ,10\n 0,10\t\n",           // spaces and tabs
        "+0,-0\n+1e1,0.\n1.0E+1,10.000\n.0,100e-1\n",       // spellings of numbers
        "# a square\n0,0\n10,0\n  # comment\n10,10\n0,10",  // comments do not end a polygon
        "\"0\",\"0\"\n\"10\",0\n10,10\n0,10",               // quoted by a spreadsheet
    };
    for (std::string const& text : texts) {
        ArenaOutline const outline = read(text);
        ASSERT_EQ(outline.polygons.size(), 1U) << text;
        EXPECT_EQ(outline.polygons[0], kSquareCorners) << text;
    }
}

TEST_F(ArenaFile, SeveralBlankLinesEndOnlyOnePolygon) {
    EXPECT_EQ(read(kSquare + "\n\n \n\n2,2\n3,2\n3,3\n\n\n").polygons.size(), 2U);
}

TEST_F(ArenaFile, EitherWindingIsAccepted) {
    EXPECT_EQ(read("0,0\n0,10\n10,10\n10,0\n\n2,2\n3,2\n3,3").polygons.size(), 2U);
    EXPECT_EQ(read("0,0\n0,10\n10,10\n10,0\n\n2,2\n3,3\n3,2").polygons.size(), 2U);
}

TEST_F(ArenaFile, LineThatIsNoCornerIsNamedWithWhatWasFound) {
    char const* const bad_lines[] = {
        "1",     "1,",    ",1",     "1,2,3",     "1,2,",    ",",          "1 2",     "1;2",      "1,5;2,5",    "one,2",
        "1,two", "nan,1", "1,NaN",  "inf,1",     "1,-inf",  "1,infinity", "0x10,1",  "1e400,1",  "1e39,1",     "1,1e",
        "--1,2", "+-1,2", "1,2abc", "1,2 # end", "1.2.3,4", "1 000,2",    "1,2\x01", "\xff\xfe", "PK\x03\x04", "1,2\"",
    };
    for (char const* const bad : bad_lines) {
        std::string const message = error_of("0,0\n# comment\n10,0\n" + std::string(bad) + "\n0,10\n");
        EXPECT_TRUE(message.starts_with("arena.csv:4: expected a corner 'x,y', found ")) << bad << " -> " << message;
    }
}

TEST_F(ArenaFile, QuotesThatDoNotCloseAreNamedWithTheirLine) {
    EXPECT_EQ(error_of("0,0\n10,0\n1,\"2\n0,10\n"),
              "arena.csv:3: a text in double quotes begins on this line and does not end");
}

TEST_F(ArenaFile, MessageShowsUnprintableBytesAndCutsLongLines) {
    EXPECT_NE(error_of("\0\x01\x7f,\n"s).find("'\\x00\\x01\\x7f,'"), std::string::npos);
    EXPECT_LT(error_of(std::string(100000, 'x')).size(), 300U);
}

TEST_F(ArenaFile, HeaderIsRefusedWithAHint) {
    EXPECT_NE(error_of("x,y\n" + kSquare).find("arena.csv:1: "), std::string::npos);
    EXPECT_NE(error_of("x,y\n" + kSquare).find("no header"), std::string::npos);
    EXPECT_NE(error_of("# comment\nx,y\n" + kSquare).find("arena.csv:2: "), std::string::npos);
}

TEST_F(ArenaFile, SemicolonsAreRefusedWithAHint) {
    EXPECT_NE(error_of("0;0\n10;0\n10;10\n").find("comma"), std::string::npos);
}

TEST_F(ArenaFile, FewerThanThreeCornersNameTheLineOfThePolygon) {
    EXPECT_EQ(error_of("1,1\n").substr(0, 12), "arena.csv:1:");
    EXPECT_EQ(error_of("\n1,1\n2,2\n").substr(0, 12), "arena.csv:2:");
    EXPECT_EQ(error_of("1,1\n2,2\n1,1\n").substr(0, 12), "arena.csv:1:");
    EXPECT_EQ(error_of("1,1\n1,1\n2,2\n2,2\n2,2\n1,1").substr(0, 12), "arena.csv:1:");
    std::string const message = error_of(kSquare + "\n1,1\n2,1\n");
    EXPECT_EQ(message.substr(0, 12), "arena.csv:6:");
    EXPECT_NE(message.find("2 different corners"), std::string::npos);
}

TEST_F(ArenaFile, PolygonWithoutAreaIsRefused) {
    for (char const* const flat :
         {"0,0\n1,1\n2,2\n", "0,0\n5,0\n9,0\n2,0\n", "3,0\n3,5\n3,9\n", "0.1,0.2\n0.2,0.4\n0.3,0.6"}) {
        std::string const message = error_of(flat);
        EXPECT_TRUE(message.starts_with("arena.csv:1: this polygon encloses no area")) << flat << " -> " << message;
    }
    EXPECT_TRUE(error_of(kSquare + "\n1,1\n2,2\n3,3\n").starts_with("arena.csv:6: this polygon encloses no area"));
}

TEST_F(ArenaFile, PolygonThatCrossesItselfNamesBothEdges) {
    EXPECT_EQ(
        error_of("# bow tie, larger below\n0,0\n10,10\n10,-5\n0,10\n"),
        "arena.csv:4: this polygon crosses itself: the edge that starts here crosses or touches the one that starts on "
        "line 2");
}

TEST_F(ArenaFile, HolesThatCrossOrTouchAnythingAreRefused) {
    std::string const holes[] = {
        "8,8\n12,8\n12,12\n8,12\n",          // across the outer polygon
        "0,0\n10,0\n10,10\n0,10\n",          // equal to it
        "10,2\n5,2\n5,5\n",                  // touching it
        "2,2\n3,2\n3,3\n\n3,3\n4,3\n4,4\n",  // touching another hole
        "2,2\n6,2\n6,6\n\n2,6\n6,3\n6,8\n",  // across another hole
    };
    for (std::string const& hole : holes) {
        std::string const message = error_of(kSquare + "\n" + hole);
        EXPECT_NE(message.find("two polygons cross"), std::string::npos) << hole << " -> " << message;
        EXPECT_TRUE(message.starts_with("arena.csv:")) << message;
    }
}

TEST_F(ArenaFile, HoleOutsideOrInsideAnotherHoleIsRefused) {
    EXPECT_TRUE(error_of(kSquare + "\n20,2\n25,2\n25,5\n").starts_with("arena.csv:6: this hole is outside"));
    EXPECT_TRUE(error_of("2,2\n5,2\n5,5\n\n" + kSquare).starts_with("arena.csv:5: this hole is outside"));
    std::string const message = error_of(kSquare + "\n2,2\n8,2\n8,8\n2,8\n\n4,4\n6,4\n6,6\n");
    EXPECT_TRUE(message.starts_with("arena.csv:11: this hole is inside the hole that starts on line 6")) << message;
}

TEST_F(ArenaFile, MissingFileFolderAndDeviceAreRefused) {
    EXPECT_NE(error_of_path(folder_ / "none.csv").find("no such file"), std::string::npos);
    EXPECT_NE(error_of_path(folder_.path()).find("found a folder"), std::string::npos);
    EXPECT_NE(error_of_path("/dev/zero").find("special file"), std::string::npos);
    EXPECT_NE(error_of_path("").find("no such file"), std::string::npos);
}

TEST_F(ArenaFile, MoreThanAMillionLinesAreRefused) {
    std::string text;
    for (int i = 0; i < 1000001; ++i) {
        text += "0,0\n";
    }
    EXPECT_TRUE(error_of(text).starts_with("arena.csv:1000001: an arena file has at most 1000000 lines"));
}

TEST_F(ArenaFile, HundredThousandCornersLoad) {
    std::string text;
    constexpr int corners = 100000;
    for (int i = 0; i < corners; ++i) {
        Vec2 const unit = direction(6.2831853F * static_cast<float>(i) / corners);
        float const radius = i % 2 == 0 ? 1000.0F : 999.0F;
        text += std::to_string(radius * unit.x) + "," + std::to_string(radius * unit.y) + "\n";
    }
    EXPECT_EQ(read(text).polygons.at(0).size(), static_cast<std::size_t>(corners));
}

TEST_F(ArenaFile, RandomBytesAreAcceptedOrRefusedWithOneMessage) {
    RandomStream random(11, 0);
    std::string const alphabet = "0123456789,.-+eE \n\n\n\t\r#;x\"\0\xff"s;
    for (int trial = 0; trial < 1000; ++trial) {
        std::string text;
        std::uint32_t const length = random.below(60);
        for (std::uint32_t i = 0; i < length; ++i) {
            text += alphabet[random.below(static_cast<std::uint32_t>(alphabet.size()))];
        }
        std::string const message = error_of(text);
        EXPECT_TRUE(message.empty() || message.starts_with("arena.csv:")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(ShippedArenas, ExistLoadAndKeepTheirAreaAtEverySize) {
    fs::path const folder = fs::path(POGOSIM_SOURCE_DIR) / "arenas";
    for (char const* const name :
         {"disk", "annulus", "square", "squarewithHole", "star", "triangle", "H", "arrow", "arena8", "line"}) {
        ArenaOutline const outline = read_arena_file(folder / (std::string(name) + ".csv"));
        for (double const surface : {1.0e5, 1.0e6, 1.0e8}) {
            EXPECT_NEAR(scale_arena(outline, {surface, false}).area_mm2, surface, 1.0e-5 * surface) << name;
        }
    }
    // Earlier simulators had empty files of these names, which meant a periodic square.
    for (char const* const name : {"empty", "torus"}) {
        ArenaOutline const outline = read_arena_file(folder / (std::string(name) + ".csv"));
        EXPECT_TRUE(outline.periodic) << name;
        EXPECT_EQ(outline.polygons, read_arena_file(folder / "square.csv").polygons) << name;
    }
}

TEST(ShippedArenas, HaveNoEdgeThatAPhysicsEngineTakesForAPoint) {
    for (auto const& entry : fs::directory_iterator(fs::path(POGOSIM_SOURCE_DIR) / "arenas")) {
        ArenaOutline const outline = read_arena_file(entry.path());
        Arena const arena = scale_arena(outline, {1.0e5, false});
        for (Polygon const& polygon : arena.polygons) {
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                EXPECT_GT(length(polygon[(i + 1) % polygon.size()] - polygon[i]), 2.0F) << entry.path();
            }
        }
    }
}

TEST(ShippedArenas, NeckOfArena8LetsFourRobotsThroughSideBySide) {
    fs::path const path = fs::path(POGOSIM_SOURCE_DIR) / "arenas" / "arena8.csv";
    Arena const arena = scale_arena(read_arena_file(path), {1.0e6, false});
    Vec2 const middle = arena.bounds.centre();
    float const neck_mm = 2.0F * arena.distance_to_walls(middle);
    EXPECT_TRUE(arena.contains(middle));
    EXPECT_GT(neck_mm, 4.0F * 53.0F);
    EXPECT_NEAR(neck_mm / arena.bounds.size().x, 0.28, 0.01);
}

}  // namespace
}  // namespace pogosim
