#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "geometry/formation.hpp"
#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

namespace fs = std::filesystem;

Arena const kRoom =
    make_arena({{{0, 0}, {1000, 0}, {1000, 500}, {0, 500}}, {{400, 200}, {600, 200}, {600, 300}, {400, 300}}});

class ImportedFormation : public testing::Test {
protected:
    ImportedFormation() {
        spec_.name = "imported";
        spec_.filename = folder_ / "poses.csv";
    }

    std::vector<Placement> place_from(std::string const& text, std::size_t count) {
        std::ofstream(spec_.filename, std::ios::binary) << text;
        return place_now(count);
    }

    std::vector<Placement> place_now(std::size_t count) {
        RandomStream random(1, 1);
        return place(spec_, std::vector<float>(count, 26.5F), {kRoom}, random, reader_);
    }

    /// The message, with the file's folder cut off.
    std::string error_of(std::string const& text, std::size_t count) {
        try {
            place_from(text, count);
        } catch (ConfigError const& error) {
            std::string const message = error.what();
            std::string const prefix = folder_.path().string() + "/";
            return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
        }
        return "";
    }

    TemporaryFolder folder_;
    FormationSpec spec_;
    PoseReader reader_;
};

TEST_F(ImportedFormation, ReadsPositionsInTheOrderOfTheFile) {
    auto const placements = place_from("10,20\n30,40\n50,60\n", 2);
    ASSERT_EQ(placements.size(), 2U);
    EXPECT_EQ(placements[0].position_mm, (Vec2{10, 20}));
    EXPECT_EQ(placements[1].position_mm, (Vec2{30, 40}));
}

TEST_F(ImportedFormation, HeaderNamesTheColumnsInAnyOrder) {
    auto const placements =
        place_from("\xEF\xBB\xBFname, theta ,y,x\r\nrobot,1.5,20,10\r\n\r\nrobot,-0.5,40,30\r\n", 2);
    EXPECT_EQ(placements[1].position_mm, (Vec2{30, 40}));
    EXPECT_FLOAT_EQ(placements[0].heading_rad, 1.5F);
    EXPECT_FLOAT_EQ(placements[1].heading_rad, -0.5F);
}

TEST_F(ImportedFormation, AngleIsTakenAsItIsAndWrapped) {
    auto const placements = place_from("x,y,angle\n10,20,0\n10,20,4\n10,20,3.14159265\n", 3);
    EXPECT_FLOAT_EQ(placements[0].heading_rad, 0.0F);
    EXPECT_NEAR(placements[1].heading_rad, 4.0 - 2.0 * std::numbers::pi, 1.0e-6);
    EXPECT_NEAR(std::abs(placements[2].heading_rad), std::numbers::pi, 1.0e-6);
}

TEST_F(ImportedFormation, WithoutAnglesHeadingsAreDrawn) {
    std::string text = "x,y,angle\n";
    for (int i = 0; i < 20; ++i) {
        text += "10,20,\n";
    }
    auto const placements = place_from(text, 20);
    for (std::size_t i = 1; i < 20; ++i) {
        EXPECT_NE(placements[i].heading_rad, placements[0].heading_rad);
    }
}

TEST_F(ImportedFormation, OnlyTheRowsOfTheFirstInstantCount) {
    std::string const text = "time,x,y\n2,1,1\n0.5,10,20\n2,2,2\n0.5,30,40\n7,3,3\n";
    EXPECT_EQ(place_from(text, 2)[1].position_mm, (Vec2{30, 40}));
    EXPECT_EQ(error_of(text, 3),
              "poses.csv: expected at least 3 poses (rows with the first time value), one for each object, found 2");
}

TEST_F(ImportedFormation, BoxOfTheFileIsMappedOntoTheArenasBox) {
    spec_.imported_min = {-1, 10};
    spec_.imported_max = {1, 20};
    auto const placements = place_from("-0.5,11\n0.9,19\n0,11\n", 3);
    EXPECT_EQ(placements[0].position_mm, (Vec2{250, 50}));
    EXPECT_FLOAT_EQ(placements[2].position_mm.x, 500.0F);
}

TEST_F(ImportedFormation, BoxThatIsNoneIsRefused) {
    spec_.imported_min = {-1, 10};
    EXPECT_TRUE(error_of("0,15\n", 1).starts_with("imported_formation_min_coords: "));
    spec_.imported_max = {1, 10};
    EXPECT_TRUE(error_of("0,15\n", 1).starts_with("imported_formation_min_coords: "));
}

TEST_F(ImportedFormation, PositionOutsideTheArenaNamesItsLine) {
    EXPECT_TRUE(
        error_of("x,y\n10,20\n# comment\n-5,20\n", 2).starts_with("poses.csv:4: the position (-5, 20) mm is outside"));
    EXPECT_TRUE(error_of("10,20\n500,250\n", 2).starts_with("poses.csv:2: the position (500, 250) mm is outside"));
    EXPECT_EQ(error_of("10,20\n-5,20\n", 1), "");  // an unused row
}

TEST_F(ImportedFormation, PositionsOutsideAreCounted) {
    EXPECT_NE(
        error_of("10,20\n-5,20\n-6,20\n", 3).find(", and 2 of 3 are; if the file is not in mm, imported_formation_"),
        std::string::npos);
}

TEST_F(ImportedFormation, FileInMetresIsRefusedWithWhatToWrite) {
    // Inside of the arena, in its corner, they would all be in each other.
    EXPECT_EQ(
        error_of("0.1,0.1\n0.9,0.4\n0.7,0.45\n", 3),
        "poses.csv: all 3 positions are within 0.8 x 0.35 mm, less than an object is wide (53 mm); the file looks "
        "like one in metres: imported_formation_min_coords and imported_formation_max_coords say which of its "
        "coordinates are the corners of the arena's bounding box");
    spec_.imported_min = {0, 0};
    spec_.imported_max = {1, 0.5};
    EXPECT_EQ(place_from("0.1,0.1\n0.9,0.4\n0.7,0.45\n", 3)[1].position_mm, (Vec2{900, 400}));
}

TEST_F(ImportedFormation, FewMillimetresApartIsNoFileInMetres) {
    EXPECT_EQ(error_of("700,400\n701,400\n", 2), "");
    EXPECT_EQ(error_of("0.1,0.1\n", 1), "");
    EXPECT_EQ(error_of("0.1,0.1\n900,400\n", 2), "");
}

TEST_F(ImportedFormation, RowWithoutAPositionIsRefused) {
    reader_ = [](fs::path const&) {
        return ImportedPoses{{{.x = 10, .y = 20}, {.x = std::nan(""), .y = 20, .row = 1}}};
    };
    spec_.filename = folder_ / "poses.feather";
    EXPECT_TRUE(error_of("", 2).starts_with("poses.feather:1: the row has no position (x nan, y 20)"))
        << error_of("", 2);
}

TEST_F(ImportedFormation, OfAPeriodicArenaMayBeAnywhereInItsBox) {
    std::ofstream(spec_.filename) << "500,250\n1000,0\n";
    RandomStream random(1, 1);
    std::vector<float> const radii(2, 26.5F);
    EXPECT_EQ(place(spec_, radii, {.domain = kRoom, .periodic = true}, random)[0].position_mm, (Vec2{500, 250}));
    EXPECT_THROW(place(spec_, radii, {.domain = kRoom}, random), ConfigError);
}

TEST_F(ImportedFormation, OverlapsAreTheUsersWish) {
    EXPECT_EQ(place_from("100,100\n100,100\n101,100\n", 3).size(), 3U);
}

TEST_F(ImportedFormation, BadRowsAreRefusedWithTheirLine) {
    EXPECT_TRUE(error_of("x,y\n1,2\n3\n", 2).starts_with("poses.csv:3: expected 2 fields"));
    EXPECT_TRUE(
        error_of("1,2\n3,abc\n", 2).starts_with("poses.csv:2: expected a finite number in column 2, found 'abc'"));
    EXPECT_TRUE(
        error_of("1,2\nnan,4\n", 2).starts_with("poses.csv:2: expected a finite number in column 1, found 'nan'"));
    EXPECT_TRUE(error_of("x,y,time\n1,2,\n", 1).starts_with("poses.csv:2: expected a finite number in column 3"));
    EXPECT_TRUE(error_of("a,b\n1,2\n", 1).starts_with("poses.csv:1: expected a header with the columns x and y"));
    EXPECT_TRUE(error_of("x;y\n1;2\n", 1).starts_with("poses.csv:1: expected a header with the columns x and y"));
    std::string const utf16 = error_of(std::string("\xff\xfex\0,\0y\0\n\0", 10), 1);
    EXPECT_TRUE(utf16.ends_with("found '\\xff\\xfex\\x00,\\x00y\\x00'")) << utf16;
    EXPECT_TRUE(error_of("x,y\n1e300,2\n", 1).starts_with("poses.csv:2: the position"));
    EXPECT_TRUE(error_of("", 1).starts_with("poses.csv: expected at least 1 pose (rows"));
    EXPECT_TRUE(error_of(std::string("\0\x01\x02\xff\n", 5), 1).starts_with("poses.csv:1: "));
}

TEST_F(ImportedFormation, NumberThatOverflowsSinglePrecisionIsShownAsWritten) {
    EXPECT_TRUE(error_of("x,y\n1e300,2\n", 1).starts_with("poses.csv:2: the position (1e+300, 2) mm is outside"));
    spec_.imported_min = {0, 0};
    spec_.imported_max = {1, 1};
    EXPECT_TRUE(error_of("x,y\n0.5,1e300\n", 1).starts_with("poses.csv:2: the position (500, 5e+302) mm is outside"));
}

TEST_F(ImportedFormation, TextInQuotesMayHaveCommasQuotesAndLineEnds) {
    auto const placements = place_from(
        "\"a \"\"name\"\", in\r\ntwo lines\",x,\"y\"\n\"1,\n2\n\n# 3\",10, \"20\" \n\"\"\"\",30,40\n\"\",50,60\n", 3);
    EXPECT_EQ(placements[0].position_mm, (Vec2{10, 20}));
    EXPECT_EQ(placements[1].position_mm, (Vec2{30, 40}));
    EXPECT_EQ(placements[2].position_mm, (Vec2{50, 60}));
}

TEST_F(ImportedFormation, LinesBelowATextOfSeveralLinesKeepTheirNumbers) {
    EXPECT_TRUE(
        error_of("x,y,name\n10,20,\"a\r\nb\rc\nd\"\nz,40,e\n", 2).starts_with("poses.csv:6: expected a finite"));
}

TEST_F(ImportedFormation, TextWhoseQuotesDoNotCloseIsRefused) {
    EXPECT_EQ(error_of("x,y,name\n10,20,\"a\n30,40,b\n", 2),
              "poses.csv:2: a text in double quotes begins on this line and does not end");
    EXPECT_EQ(error_of("# 5\" of rain\nx,y,name\n10,20,5\" wide\n", 1), "");
}

TEST_F(ImportedFormation, ColumnThatIsThereTwiceIsRefused) {
    EXPECT_EQ(error_of("x,y,x\n10,20,30\n", 1),
              "poses.csv:1: the header has several columns 'x'; rename or remove all but one");
    EXPECT_NE(error_of("time,x,y,time\n0,10,20,30\n", 1), "");
    EXPECT_NE(error_of("angle,x,y,angle\n0,10,20,30\n", 1), "");
    EXPECT_EQ(error_of("a,x,y,a\n0,10,20,30\n", 1), "");
}

class AnglesOfAFile : public ImportedFormation {
protected:
    AnglesOfAFile() { log().sinks().push_back(std::make_shared<spdlog::sinks::ostream_sink_mt>(messages_)); }
    ~AnglesOfAFile() override { log().sinks().pop_back(); }

    std::ostringstream messages_;
};

TEST_F(AnglesOfAFile, InDegreesAreToldOnce) {
    place_from("x,y,angle\n10,20,0\n30,40,90\n50,60,180\n70,80,-270\n", 4);
    std::string const text = messages_.str();
    EXPECT_NE(text.find("poses.csv:3: the angle 90 rad is unusually large, like those of 2 other rows; if you meant "
                        "degrees, write 1.5708\n"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("unusually"), text.rfind("unusually"));
}

TEST_F(AnglesOfAFile, UpToAFullTurnAreUsual) {
    place_from("x,y,angle\n10,20,6.2832\n30,40,-6.28319\n50,60,\n", 3);
    EXPECT_EQ(messages_.str(), "");
}

TEST_F(AnglesOfAFile, ThatAreNotReadAreToldOnce) {
    struct Case {
        std::string header;
        std::string told;
    };
    std::string const random = "headings are random, since no column is named 'angle' or 'theta'; ";
    for (auto const& [header, told] :
         {Case{"x,y,heading", random + "'heading' is ignored. If 'heading' is the heading in radians, name it 'angle'"},
          Case{"x,y,angel", random + "'angel' is ignored. If 'angel' is the heading in radians, name it 'angle'"},
          Case{"x,y,Angle", random + "'Angle' is ignored. If 'Angle' is"},
          Case{"x,y,orientation", random + "'orientation' is ignored. If"},
          Case{"id,x,y,yaw_deg", random + "'id', 'yaw_deg' are ignored. If 'yaw_deg' is"},
          Case{"x,y,theta (rad),note", random + "'theta (rad)', 'note' are ignored. If 'theta (rad)' is"},
          Case{"angle,x,y,theta", "headings are those of 'theta'; 'angle' is ignored"},
          Case{"id,x,y,note", random + "'id', 'note' are ignored"},
          Case{"x,y,robot_category", "headings are random: the data file has no column 'angle'"}}) {
        messages_.str("");
        place_from(header + "\n10,20,30,40\n50,60,70,80\n", 2);
        std::string const text = messages_.str();
        EXPECT_NE(text.find("poses.csv: " + told), std::string::npos) << text;
        EXPECT_EQ(text.find("poses.csv: "), text.rfind("poses.csv: ")) << text;
    }
    for (char const* const header :
         {"x,y", "x,y,time", "theta,id,x,y", "x,y,angle,heading", ",x,y", "x,y,angle,theta,robot_category"}) {
        messages_.str("");
        place_from(std::string(header) + "\n30,30,30,30,30\n", 1);
        EXPECT_EQ(messages_.str().find("heading"), std::string::npos) << messages_.str();
    }
}

TEST_F(AnglesOfAFile, WithoutAHeaderAreToldOnce) {
    place_from("10,20,0\n30,40,1.5\n", 2);
    EXPECT_NE(messages_.str().find("poses.csv: only the first two of 3 columns are read, as x and y, and headings are "
                                   "random: the file has no header. For headings in radians, let it begin with the "
                                   "line x,y,angle\n"),
              std::string::npos)
        << messages_.str();
    messages_.str("");
    place_from("10,20\n30,40\n", 2);
    EXPECT_EQ(messages_.str(), "");
}

TEST_F(ImportedFormation, MissingFileOrNameIsRefused) {
    EXPECT_THROW(place_now(1), ConfigError);
    spec_.filename = folder_.path().string();
    EXPECT_THROW(place_now(1), ConfigError);
    spec_.filename = "";
    EXPECT_THROW(place_now(1), ConfigError);
}

TEST_F(ImportedFormation, FeatherFilesGoToTheReaderThatIsGiven) {
    spec_.filename = "poses.feather";
    EXPECT_THROW(place_now(1), ConfigError);
    fs::path asked;
    reader_ = [&](fs::path const& path) -> ImportedPoses {
        asked = path;
        return {{{.x = 700, .y = 20, .heading_rad = 1.0, .time_s = 2.0, .row = 1},
                 {.x = 10, .y = 20, .heading_rad = 0.25, .time_s = 1.0, .row = 2},
                 {.x = 30, .y = 40, .time_s = 1.0, .row = 3}}};
    };
    auto const placements = place_now(2);
    EXPECT_EQ(asked, "poses.feather");
    EXPECT_EQ(placements[0].position_mm, (Vec2{10, 20}));
    EXPECT_FLOAT_EQ(placements[0].heading_rad, 0.25F);
    EXPECT_EQ(placements[1].position_mm, (Vec2{30, 40}));
}

}  // namespace
}  // namespace pogosim
