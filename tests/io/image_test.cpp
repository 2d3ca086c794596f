// Pictures: what is written comes back, Radiance files in all their old forms, and files that are broken.
#include <vitrail/io/image.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include <vitrail/core/error.h>

#include "tests/support/data.h"

namespace vitrail {
namespace {

/// A folder of its own for each test, removed with everything in it.
class Pictures : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / ("vitrail_" + std::to_string(::getpid()) + "_" + info->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

Picture fromText(const std::string& bytes, const std::string& name = "test.hdr") {
    return loadPictureFromMemory(std::as_bytes(std::span(bytes)), name);
}

std::string hdrHead(const std::string& resolution) { return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n"; }

// Red r/256, green g/256, blue b/256 at exponent 128 (a factor of 1).
std::string rgbe(int r, int g, int b, int e = 128) {
    return {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b), static_cast<char>(e)};
}

ErrorCode codeOf(const std::string& bytes, const std::string& name = "test.hdr") {
    try {
        fromText(bytes, name);
    } catch (const Error& error) {
        EXPECT_NE(error.text().where.find(name), std::string::npos) << error.what();
        return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::cancelled;
}

Picture ramp(std::uint32_t w, std::uint32_t h) {
    Picture picture(w, h, Float4(0.0f, 0.0f, 0.0f, 1.0f));
    for (std::uint32_t y = 0; y < h; ++y) {
        for (std::uint32_t x = 0; x < w; ++x) picture.at(x, y) = Float4(x / 8.0f, y / 4.0f, float(x * y) / 16.0f, 1.0f);
    }
    return picture;
}

std::string contents(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Eighths and sixteenths below 2048 are exact in half floats.
TEST_F(Pictures, ExrRoundTripKeepsEveryHalf) {
    Picture picture = ramp(13, 5);
    picture.at(3, 2).w = 0.25f;
    savePicture(folder_ / "a.exr", picture);
    const Picture back = loadPicture(folder_ / "a.exr");
    ASSERT_EQ(back.width, 13u);
    ASSERT_EQ(back.height, 5u);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) EXPECT_EQ(back.pixels[i], picture.pixels[i]) << i;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "a temporary file was left behind";
}

TEST_F(Pictures, ExrOfValuesBeyondHalfFloatsStaysFinite) {
    Picture picture(2, 1, Float4(1e9f, -3.0f, NAN, 1.0f));
    savePicture(folder_ / "a.exr", picture);
    EXPECT_EQ(loadPicture(folder_ / "a.exr").at(1, 0), Float4(65504.0f, 0.0f, 0.0f, 1.0f));
}

// The curve of the header, worked out again from Hable's formula: f(x)/f(4), then sRGB.
TEST_F(Pictures, PngIsToneMappedToSrgb) {
    Picture picture(4, 1, Float4(0.0f, 0.0f, 0.0f, 1.0f));
    picture.at(1, 0) = Float4(0.18f, 0.5f, 1.0f, 1.0f);
    picture.at(2, 0) = Float4(2.0f, 4.0f, 100.0f, 1.0f);
    picture.at(3, 0) = Float4(INFINITY, NAN, -1.0f, 1.0f);
    savePicture(folder_ / "a.png", picture, 2.0f);
    const Picture back = loadPicture(folder_ / "a.png");
    const auto curve = [](double x) { return ((x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06)) - 0.02 / 0.30; };
    for (std::uint32_t x = 0; x < 3; ++x) {
        for (int c = 0; c < 3; ++c) {
            const double expected = std::min(curve(2.0 * picture.at(x, 0)[c]) / curve(4.0), 1.0);
            // Half a step of 1/255 in sRGB, whose slope is at most 2.4 / 1.055 in linear terms at white.
            EXPECT_NEAR(back.at(x, 0)[c], expected, 0.0046) << x << " " << c;
        }
    }
    EXPECT_EQ(back.at(0, 0), Float4(0.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(back.at(3, 0), Float4(0.0f, 0.0f, 0.0f, 1.0f));
}

// Stored as it is: a colour under alpha 0 does not fade.
TEST_F(Pictures, PngAlphaIsNotMultipliedIn) {
    Picture picture(2, 1, Float4(4.0f, 4.0f, 4.0f, 0.0f));
    picture.at(1, 0).w = 1.0f;
    savePicture(folder_ / "a.png", picture);
    const Picture back = loadPicture(folder_ / "a.png");
    EXPECT_EQ(back.at(0, 0), Float4(1.0f, 1.0f, 1.0f, 0.0f));
    EXPECT_EQ(back.at(1, 0), Float4(1.0f));
}

TEST_F(Pictures, WhatCannotBeWrittenIsAnError) {
    const Picture good(2, 2, Float4(1.0f));
    EXPECT_THROW(savePicture(folder_ / "a.gif", good), Error);
    EXPECT_THROW(savePicture(folder_ / "a.png", Picture()), Error);
    EXPECT_THROW(savePicture(folder_ / "a.png", good, 0.0f), Error);
    EXPECT_THROW(savePicture(folder_ / "none" / "a.png", good), Error);
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(Pictures, FileAndMemoryAreTheSame) {
    savePicture(folder_ / "a.exr", ramp(40, 3));
    EXPECT_NE(contents(folder_ / "a.exr").find("1970:01:01 00:00:00"), std::string::npos) << "the same bytes at any time";
    const Picture file = loadPicture(folder_ / "a.exr"), memory = fromText(contents(folder_ / "a.exr"), "no ending");
    EXPECT_EQ(file.pixels, memory.pixels);
}

TEST_F(Pictures, EveryCutOfAFileIsAnError) {
    savePicture(folder_ / "a.exr", ramp(40, 30));
    savePicture(folder_ / "a.png", ramp(40, 30));
    for (const char* name : {"a.exr", "a.png"}) {
        const std::string whole = contents(folder_ / name);
        for (std::size_t length = 0; length + 16 < whole.size(); length += 1 + length / 7) {
            EXPECT_THROW(fromText(whole.substr(0, length), name), Error) << name << " cut to " << length;
        }
    }
}

TEST_F(Pictures, NoPictureIsAnError) {
    EXPECT_EQ(codeOf(""), ErrorCode::badFile);
    EXPECT_EQ(codeOf("not a picture", "test.txt"), ErrorCode::unsupported);
    EXPECT_THROW(loadPicture(folder_ / "none.png"), Error);
    // OpenImageIO's reader throws an error of the standard library here.
    EXPECT_EQ(codeOf("GIF82\n\x80\x40 \x81\x80\x40 \x81\x80\x40 \x81i\x40 \x81", "test.gif"), ErrorCode::badFile);
}

TEST(Radiance, FlatPixels) {
    const Picture picture = fromText(hdrHead("-Y 2 +X 2") + rgbe(128, 64, 32) + rgbe(0, 0, 0, 0) + rgbe(255, 0, 0, 129) + rgbe(1, 1, 2));
    ASSERT_EQ(picture.width, 2u);
    ASSERT_EQ(picture.height, 2u);
    EXPECT_EQ(picture.at(0, 0), Float4(0.5f, 0.25f, 0.125f, 1.0f));
    EXPECT_EQ(picture.at(1, 0), Float4(0.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(picture.at(0, 1), Float4(255 / 128.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(picture.at(1, 1), Float4(1 / 256.0f, 1 / 256.0f, 2 / 256.0f, 1.0f));
}

// A pixel of 1, 1, 1, n repeats the one before n times, a second one in a row 256 n times.
TEST(Radiance, OldRunLengths) {
    std::string data = hdrHead("-Y 1 +X 300") + rgbe(128, 0, 0);
    data += rgbe(1, 1, 1, 40) + rgbe(1, 1, 1, 1);  // 40 + 256 more
    data += rgbe(0, 128, 0) + rgbe(1, 1, 1, 2);
    const Picture picture = fromText(data);
    for (std::uint32_t x = 0; x < 300; ++x) {
        EXPECT_EQ(picture.at(x, 0), x < 297 ? Float4(0.5f, 0.0f, 0.0f, 1.0f) : Float4(0.0f, 0.5f, 0.0f, 1.0f)) << x;
    }
}

std::string newRunLengths(std::uint32_t w, std::uint32_t h) {
    std::string data;
    for (std::uint32_t y = 0; y < h; ++y) {
        data += {2, 2, static_cast<char>(w >> 8), static_cast<char>(w & 255)};
        for (int channel = 0; channel < 4; ++channel) {
            for (std::uint32_t x = 0; x < w;) {
                const std::uint32_t run = std::min(w - x, 100u);
                data += {static_cast<char>(128 + run), static_cast<char>(channel == 3 ? 128 : 64 * (channel + 1) / (1 + int(y)))};
                x += run;
            }
        }
    }
    return data;
}

TEST(Radiance, NewRunLengths) {
    const Picture picture = fromText(hdrHead("-Y 3 +X 300") + newRunLengths(300, 3));
    EXPECT_EQ(picture.at(299, 0), Float4(0.25f, 0.5f, 0.75f, 1.0f));
    EXPECT_EQ(picture.at(0, 2).z, 0.25f);
}

// All eight ways to hold the picture  A B C / D E F  with row 0 at the top.
TEST(Radiance, TurnedAxes) {
    const std::string a = rgbe(10, 0, 0), b = rgbe(20, 0, 0), c = rgbe(30, 0, 0), d = rgbe(40, 0, 0), e = rgbe(50, 0, 0),
                      f = rgbe(60, 0, 0);
    const std::pair<const char*, std::string> cases[] = {{"-Y 2 +X 3", a + b + c + d + e + f}, {"+Y 2 +X 3", d + e + f + a + b + c},
                                                         {"-Y 2 -X 3", c + b + a + f + e + d}, {"+Y 2 -X 3", f + e + d + c + b + a},
                                                         {"+X 3 -Y 2", a + d + b + e + c + f}, {"-X 3 -Y 2", c + f + b + e + a + d},
                                                         {"+X 3 +Y 2", d + a + e + b + f + c}, {"-X 3 +Y 2", f + c + e + b + d + a}};
    for (const auto& [axes, pixels] : cases) {
        const Picture picture = fromText(hdrHead(axes) + pixels);
        ASSERT_EQ(picture.width, 3u) << axes;
        ASSERT_EQ(picture.height, 2u) << axes;
        for (std::uint32_t i = 0; i < 6; ++i) {
            EXPECT_EQ(picture.at(i % 3, i / 3).x, float(i + 1) * 10 / 256) << axes << " pixel " << i;
        }
    }
}

TEST(Radiance, TheLargestExponentIsFinite) {
    const Picture picture = fromText(hdrHead("-Y 1 +X 2") + rgbe(255, 255, 255, 255) + rgbe(0, 1, 0, 255));
    for (const Float4& pixel : picture.pixels) {
        for (int channel = 0; channel < 4; ++channel) EXPECT_TRUE(std::isfinite(pixel[channel]) && pixel[channel] >= 0.0f);
    }
}

TEST(Radiance, BadSizesAreErrors) {
    const std::string pixels(4096, '\x40');
    for (const char* resolution : {"-Y 0 +X 0", "-Y 0 +X 4", "-Y 4 +X 0", "-Y -4 +X 4", "-Y 4 +X -4", "-Y 4", "4 4", "-Y 4 +Y 4", "",
                                   "-Y 99999999999 +X 4", "-Y 2000000000 +X 2000000000", "-Y 20000 +X 4", "-Y 16384 +X 16384"}) {
        EXPECT_EQ(codeOf(hdrHead(resolution) + pixels), ErrorCode::badFile) << resolution;
    }
    EXPECT_EQ(codeOf("#?RADIANCE\n"), ErrorCode::badFile);
    EXPECT_EQ(codeOf("#?"), ErrorCode::badFile);
    EXPECT_EQ(codeOf("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"), ErrorCode::unsupported);
}

TEST(Radiance, BrokenRunsAreErrors) {
    const std::string good = newRunLengths(300, 3);
    for (std::size_t length = 0; length < good.size(); length += 3) {
        EXPECT_EQ(codeOf(hdrHead("-Y 3 +X 300") + good.substr(0, length)), ErrorCode::badFile) << length;
    }
    std::string past = hdrHead("-Y 1 +X 10") + std::string("\x02\x02\x00\x0a", 4) + "\xff\x10";  // a run of 127 in a row of 10
    EXPECT_EQ(codeOf(past + std::string(100, '\x85')), ErrorCode::badFile);
    EXPECT_EQ(codeOf(hdrHead("-Y 1 +X 10") + rgbe(1, 2, 3) + rgbe(1, 1, 1, 200)), ErrorCode::badFile);
    EXPECT_EQ(codeOf(hdrHead("-Y 1 +X 10") + rgbe(1, 1, 1, 10)), ErrorCode::badFile) << "nothing to repeat";
}

TEST(Radiance, CutEnvironmentsAreErrors) {
    const auto file = test::dataFile("env/studio_small_03_1k.hdr");
    VITRAIL_NEEDS_DATA(file);
    const Picture whole = loadPicture(file);
    EXPECT_EQ(whole.width, 1024u);
    EXPECT_EQ(whole.height, 512u);
    double sum = 0, peak = 0;
    for (const Float4& p : whole.pixels) {
        const double luminance = 0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z;
        sum += luminance;
        peak = std::max(peak, luminance);
    }
    EXPECT_NEAR(sum / double(whole.pixels.size()), 1.85, 0.01);  // as counted in the data's own README
    EXPECT_NEAR(peak, 3352, 20);
    const std::string bytes = contents(file);
    for (double share : {0.0001, 0.3, 0.77, 0.999}) {
        EXPECT_EQ(codeOf(bytes.substr(0, static_cast<std::size_t>(share * double(bytes.size())))), ErrorCode::badFile) << share;
    }
}

}  // namespace
}  // namespace vitrail
