#include "config/user_parameters.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <vector>

#include "config/yaml_text.hpp"
#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

Node const kParameters = parse_yaml(
    "run_duration_min: 1000\nratio: 0.25\nback: yes\nname: Ada\nvect: [1, 2.5, 3]\nfloat_text: '12.9'\nword: fast\n"
    "empty: []\nnothing:\np: {k: 7, list: [4, 5]}\na.b: 8\nbig: 1e40\nmap: {x: 1}\nmixed: [1, two]\n"
    "infinite: -.inf\nfar: [1, -1e39]\n",
    "x.yaml");

}  // namespace

TEST(UserParameters, ValuesAreFoundByNameAndPath) {
    EXPECT_EQ(integer_parameter(kParameters, "run_duration_min", 0, 4294967295), 1000);
    EXPECT_EQ(number_parameter(kParameters, "ratio"), 0.25);
    EXPECT_EQ(bool_parameter(kParameters, "back"), true);
    EXPECT_EQ(text_parameter(kParameters, "name"), "Ada");
    EXPECT_EQ(text_parameter(kParameters, "run_duration_min"), "1000");
    EXPECT_EQ(integer_parameter(kParameters, "p.k", 0, 255), 7);
    EXPECT_EQ(integer_parameter(kParameters, "p.list.1", 0, 255), 5);
    EXPECT_EQ(integer_parameter(kParameters, "a.b", 0, 255), 8);
    EXPECT_EQ(integer_parameter(kParameters, "float_text", 0, 255), 12);
    EXPECT_EQ(number_parameter(kParameters, "big"), 1e40);
}

TEST(UserParameters, AbsentAndNullLeaveTheProgramsDefault) {
    for (char const* name : {"unknown", "nothing", "p.unknown", "", "ratio.x"}) {
        EXPECT_EQ(integer_parameter(kParameters, name, 0, 255), std::nullopt) << name;
        EXPECT_EQ(number_parameter(kParameters, name), std::nullopt) << name;
        EXPECT_EQ(bool_parameter(kParameters, name), std::nullopt) << name;
        EXPECT_EQ(text_parameter(kParameters, name), std::nullopt) << name;
        EXPECT_EQ(numbers_parameter(kParameters, name, 3), std::nullopt) << name;
    }
    EXPECT_EQ(number_parameter(Node{}, "ratio"), std::nullopt);
}

TEST(UserParameters, WrongTypesAreErrorsWithTheirLine) {
    EXPECT_EQ(error_of([] { integer_parameter(kParameters, "word", 0, 4294967295); }),
              "x.yaml:7: parameters.word: expected an integer from 0 to 4294967295, found 'fast'");
    EXPECT_EQ(error_of([] { integer_parameter(kParameters, "run_duration_min", 0, 255); }),
              "x.yaml:1: parameters.run_duration_min: expected an integer from 0 to 255, found 1000");
    EXPECT_EQ(error_of([] { number_parameter(kParameters, "word"); }),
              "x.yaml:7: parameters.word: expected a number, found 'fast'");
    EXPECT_EQ(error_of([] { bool_parameter(kParameters, "ratio"); }),
              "x.yaml:2: parameters.ratio: expected true or false, found 0.25");
    EXPECT_EQ(error_of([] { text_parameter(kParameters, "map"); }),
              "x.yaml:13: parameters.map: expected a string, found a map");
}

TEST(UserParameters, NumbersThatDoNotFitAFloatAreErrorsInAFloat) {
    constexpr double kLargestFloat = std::numeric_limits<float>::max();
    EXPECT_EQ(number_parameter(kParameters, "ratio", kLargestFloat), 0.25);
    EXPECT_EQ(number_parameter(kParameters, "infinite", kLargestFloat), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(error_of([] { number_parameter(kParameters, "big", kLargestFloat); }),
              "x.yaml:12: parameters.big: expected a number from -3.4028234663852886e+38 to 3.4028234663852886e+38, "
              "found 1e40");
    EXPECT_EQ(error_of([] { numbers_parameter(kParameters, "far", 2, kLargestFloat); }),
              "x.yaml:16: parameters.far.1: expected a number from -3.4028234663852886e+38 to 3.4028234663852886e+38, "
              "found -1e39");
}

TEST(UserParameters, ListsGiveTheirFirstNumbers) {
    EXPECT_EQ(numbers_parameter(kParameters, "vect", 3), (std::vector{1.0, 2.5, 3.0}));
    EXPECT_EQ(numbers_parameter(kParameters, "vect", 2), (std::vector{1.0, 2.5}));
    EXPECT_EQ(numbers_parameter(kParameters, "empty", 2), std::nullopt);
    EXPECT_EQ(error_of([] { numbers_parameter(kParameters, "vect", 4); }),
              "x.yaml:5: parameters.vect: expected a list of at least 4 numbers, found 3");
    EXPECT_EQ(error_of([] { numbers_parameter(kParameters, "ratio", 4); }),
              "x.yaml:2: parameters.ratio: expected a list of at least 4 numbers, found 0.25");
    EXPECT_EQ(error_of([] { numbers_parameter(kParameters, "mixed", 2); }),
              "x.yaml:14: parameters.mixed.1: expected a number, found 'two'");
}
