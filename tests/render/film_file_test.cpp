// Films without a run: names, and errors that keep them from being written.
#include "render/film_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

class FilmFiles : public testing::Test {
protected:
    void SetUp() override {
        if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
            GTEST_SKIP() << "ffmpeg is not installed";
        }
    }

    TemporaryFolder folder_;
};

std::string error_of_film(std::string const& path) {
    try {
        FilmFile const film(path, {16, 16});
    } catch (ConfigError const& error) {
        return error.what();
    }
    return "no error";
}

TEST(FilmFormat, IsThatOfTheEndingInUpperOrLowerCase) {
    EXPECT_EQ(film_format("a.mp4").encoder, "libx264");
    EXPECT_EQ(film_format("a/b.WebM").encoder, "libvpx-vp9");
    EXPECT_EQ(film_format("a.b.gif").encoder, "gif");
}

TEST(FilmFormat, OtherEndingsAreRefused) {
    for (std::string const name : {"a.avi", "a", "mp4", ".mp4", "a.mp4/b"}) {
        EXPECT_EQ(error_of_film(name),
                  "--video: expected a name that ends in .mp4, .webm or .gif, found '" + name + "'");
    }
}

TEST_F(FilmFiles, FilmStandsThereOnceItIsFinished) {
    FilmFile film(folder_ / "new/a.mp4", {17, 15});
    Canvas canvas({17, 15});
    film.add(canvas, 1);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "new/a.mp4"));
    film.add(canvas, 10);
    film.finish();
    EXPECT_GT(std::filesystem::file_size(folder_ / "new/a.mp4"), 500U);
    EXPECT_FALSE(std::filesystem::exists(FilmFile::path_beside(folder_ / "new/a.mp4")));
}

TEST_F(FilmFiles, FilmThatIsGivenUpOrEmptyLeavesTheOlderOne) {
    std::ofstream(folder_ / "a.gif") << "an older film";
    {
        FilmFile film(folder_ / "a.gif", {16, 16});
        film.add(Canvas({16, 16}), 3);
    }
    FilmFile empty(folder_ / "a.gif", {16, 16});
    empty.finish();
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.gif"});
    EXPECT_EQ(std::filesystem::file_size(folder_ / "a.gif"), 13U);
}

TEST_F(FilmFiles, TwoRunsCannotMakeTheSameFilm) {
    FilmFile const film(folder_ / "a.mp4", {16, 16});
    EXPECT_NE(error_of_film(folder_ / "a.mp4").find("in use by another run"), std::string::npos);
}

TEST_F(FilmFiles, PlaceThatIsNoFileIsRefused) {
    std::filesystem::create_directory(folder_ / "a.mp4");
    EXPECT_EQ(error_of_film(folder_ / "a.mp4"),
              "--video: the film '" + folder_ / "a.mp4" +
                  "' cannot be written: this is not a regular file; choose another file");
    std::ofstream(folder_ / "file") << "a file";
    EXPECT_NE(error_of_film(folder_ / "file/b.mp4").find("cannot be written: Not a directory"), std::string::npos);
}

}  // namespace
}  // namespace pogosim
