// PNG files, read back with libpng's own simple reader.
#include "render/png_file.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/locked_file.hpp"
#include "support/file_size_limit.hpp"
#include "support/temporary_folder.hpp"

namespace pogosim {
namespace {

Canvas colourful(PictureSize size) {
    Canvas canvas(size);
    std::uint32_t next = 12345;
    for (Pixel& pixel : canvas.pixels()) {
        next = next * 1664525U + 1013904223U;
        pixel = 0xFF000000U | next >> 8U;
    }
    return canvas;
}

struct Read {
    png_image image{};
    std::vector<Pixel> pixels;
};

Read read_png(std::string const& path) {
    Read read;
    read.image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&read.image, path.c_str()), 0) << read.image.message;
    EXPECT_EQ(read.image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
    read.image.format = PNG_FORMAT_RGB;
    std::vector<png_byte> bytes(PNG_IMAGE_SIZE(read.image));
    EXPECT_NE(png_image_finish_read(&read.image, nullptr, bytes.data(), 0, nullptr), 0) << read.image.message;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        read.pixels.push_back(0xFF000000U | static_cast<Pixel>(bytes[i]) << 16U |
                              static_cast<Pixel>(bytes[i + 1]) << 8U | static_cast<Pixel>(bytes[i + 2]));
    }
    return read;
}

std::string bytes_of(std::string const& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string error_at(std::string const& path, PictureSize size = {5, 5}) {
    try {
        write_png(path, colourful(size));
    } catch (FileError const& error) {
        return error.what();
    }
    return "no error";
}

class PngSizes : public testing::TestWithParam<PictureSize> {};

TEST_P(PngSizes, PictureReadsBackAsItWasWritten) {
    TemporaryFolder const folder;
    Canvas const canvas = colourful(GetParam());
    write_png(folder / "a.png", canvas);
    Read const read = read_png(folder / "a.png");
    EXPECT_EQ(static_cast<int>(read.image.width), GetParam().width_px);
    EXPECT_EQ(static_cast<int>(read.image.height), GetParam().height_px);
    EXPECT_EQ(read.pixels, std::vector<Pixel>(canvas.pixels().begin(), canvas.pixels().end()));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
}

INSTANTIATE_TEST_SUITE_P(Sizes, PngSizes,
                         testing::Values(PictureSize{1, 1}, PictureSize{3, 2}, PictureSize{1, 300},
                                         PictureSize{801, 333}));

TEST(PngFile, SamePictureGivesTheSameBytes) {
    TemporaryFolder const folder;
    write_png(folder / "a.png", colourful({100, 50}));
    write_png(folder / "b.png", colourful({100, 50}));
    EXPECT_EQ(bytes_of(folder / "a.png"), bytes_of(folder / "b.png"));
}

TEST(PngFile, ReplacesAnOlderPictureOfTheSameName) {
    TemporaryFolder const folder;
    write_png(folder / "a.png", colourful({100, 50}));
    write_png(folder / "a.png", colourful({7, 5}));
    EXPECT_EQ(read_png(folder / "a.png").image.width, 7U);
}

TEST(PngFile, SystemsReasonIsGivenAndNothingIsLeft) {
    TemporaryFolder const folder;
    EXPECT_EQ(error_at(folder / "missing/a.png"), "No such file or directory");
    EXPECT_EQ(error_at(folder / std::string(300, 'a')), "File name too long");
    mkdir((folder / "a.png").c_str(), 0777);
    EXPECT_EQ(error_at(folder / "a.png"), "Is a directory");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
}

TEST(PngFile, FullDiskIsAnErrorAndNothingIsLeft) {
    TemporaryFolder const folder;
    FileSizeLimit const limit(1000);
    EXPECT_EQ(error_at(folder / "a.png", {100, 50}), "File too large");
    EXPECT_TRUE(folder.names().empty());
}

TEST(PngFile, NothingIsWrittenToWhatStandsAtItsNameOnTheWay) {
    TemporaryFolder const folder;
    std::ofstream(folder / "kept") << "kept";
    for (int const kind : {0, 1}) {
        std::string const on_the_way = unfinished_png(folder / "a.png");
        ASSERT_EQ(kind == 0 ? symlink((folder / "kept").c_str(), on_the_way.c_str()) : mkfifo(on_the_way.c_str(), 0600),
                  0);
        write_png(folder / "a.png", colourful({7, 5}));
        EXPECT_EQ(read_png(folder / "a.png").image.width, 7U);
        EXPECT_EQ(bytes_of(folder / "kept"), "kept");
        EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.png", "kept"}));
    }
}

}  // namespace
}  // namespace pogosim
