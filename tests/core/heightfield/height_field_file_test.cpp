#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "beltgrinding/error.h"
#include "beltgrinding/height_field.h"
#include "heightfield/sound_field.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

class HeightFieldFile : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("beltgrinding-test-" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        path_ = (folder_ / "field.h5").string();
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string bytes() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void overwrite(const std::string& content) const {
        std::ofstream(path_, std::ios::binary | std::ios::trunc) << content;
    }

    /// Puts another value into an array of the file, whose checksums are then right again.
    template <class T>
    void put(const char* array, const std::vector<hsize_t>& place, hid_t type, T value) const {
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        const hid_t set = H5Dopen2(file, array, H5P_DEFAULT);
        const hid_t space = H5Dget_space(set);
        const std::vector<hsize_t> one(place.size(), 1);
        const hid_t memory = H5Screate_simple(1, one.data(), nullptr);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, place.data(), nullptr, one.data(), nullptr);
        EXPECT_GE(H5Dwrite(set, type, memory, space, H5P_DEFAULT, &value), 0);
        H5Sclose(memory), H5Sclose(space), H5Dclose(set), H5Fclose(file);
    }

    std::filesystem::path folder_;
    std::string path_;
};

TEST_F(HeightFieldFile, ComesBackAsItWas) {
    HeightField field = testing::cylinder(30.0, 20.0, 15.0, 0.7, 0.25);
    field.height[5] = -0.125;
    field.flags[7] |= kMissed;
    field.face[9] = 3;
    field.depth = 1.5;
    write_hdf5(field, path_, "{\"a\": 1}");
    std::string attributes;
    const HeightField back = read_hdf5(path_, &attributes);
    EXPECT_EQ(attributes, "{\"a\": 1}");
    EXPECT_EQ(back.point, field.point);
    EXPECT_EQ(back.normal, field.normal);
    EXPECT_EQ(back.area, field.area);
    EXPECT_EQ(back.height, field.height);
    EXPECT_EQ(back.stock_height, field.stock_height);
    EXPECT_EQ(back.face, field.face);
    EXPECT_EQ(back.flags, field.flags);
    EXPECT_EQ(back.triangles, field.triangles);
    EXPECT_EQ(back.spacing, field.spacing);
    EXPECT_EQ(back.depth, field.depth);
}

TEST_F(HeightFieldFile, TheTraceComesBackAndAFileWithoutOpens) {
    HeightField field = testing::plate(3.0, 2.0, 1.0, 0.2);
    write_hdf5(field, path_, "");
    EXPECT_TRUE(read_hdf5(path_).trace.empty());
    field.trace.reset(field.size());
    field.trace.first[2] = 1;
    field.trace.dominant[2] = 4;
    field.trace.last[2] = 9;
    field.trace.dominant_depth[2] = 0.125F;
    field.trace.peak_pressure[3] = 0.5F;
    write_hdf5(field, path_, "");
    const RemovalTrace back = read_hdf5(path_).trace;
    EXPECT_EQ(back.first, field.trace.first);
    EXPECT_EQ(back.last, field.trace.last);
    EXPECT_EQ(back.dominant, field.trace.dominant);
    EXPECT_EQ(back.dominant_depth, field.trace.dominant_depth);
    EXPECT_EQ(back.peak_pressure, field.trace.peak_pressure);
    for (const auto& spoil : {+[](RemovalTrace& t) { t.last[2] = RemovalTrace::kNever; },
                              +[](RemovalTrace& t) { t.dominant_depth[2] = NAN; },
                              +[](RemovalTrace& t) { t.peak_pressure[2] = -1.0F; },
                              +[](RemovalTrace& t) { t.dominant.pop_back(); }}) {
        HeightField bad = field;
        spoil(bad.trace);
        EXPECT_THROW(write_hdf5(bad, path_, ""), std::logic_error);
        EXPECT_EQ(read_hdf5(path_).trace.last, field.trace.last);  // the old one
    }
    put("trace_last_motion", {2}, H5T_NATIVE_UINT32, RemovalTrace::kNever);
    EXPECT_THROW(read_hdf5(path_), InputError);
    write_hdf5(field, path_, "");
    put("trace_peak_pressure_MPa", {3}, H5T_NATIVE_FLOAT, INFINITY);
    EXPECT_THROW(read_hdf5(path_), InputError);
}

// What a reader would refuse is not written: who computed it is told where it is wrong.
TEST_F(HeightFieldFile, WhatIsNotSoundIsNoFile) {
    const HeightField field = testing::plate(3.0, 2.0, 1.0, 0.2);
    const auto fault = [&](auto spoil) -> std::string {
        HeightField bad = field;
        bad.heat.rise.assign(bad.size(), 300.0F);
        bad.heat.motion.assign(bad.size(), 1);
        check_sound(bad);
        spoil(bad);
        try {
            check_sound(bad);
        } catch (const std::logic_error& error) {
            EXPECT_THROW(hdf5_image(bad, ""), std::logic_error);
            return error.what();
        }
        return "";
    };
    const auto names = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(names(fault([](HeightField& f) { f.height[4] = NAN; }), "sample 4"));
    EXPECT_TRUE(names(fault([](HeightField& f) { f.stock_height[4] = INFINITY; }), "sample 4"));
    EXPECT_TRUE(names(fault([](HeightField& f) { f.area[5] = -1.0F; }), "sample 5"));
    EXPECT_TRUE(names(fault([](HeightField& f) { f.heat.rise[2] = 4.7e11F; }), "sample 2"));
    EXPECT_TRUE(names(fault([](HeightField& f) { f.measured.assign(1, 0.0F); }), "measured"));
}

TEST(HeightField, WhatIsGroundIsNeverLessThanNothing) {
    HeightField field = testing::plate(3.0, 2.0, 1.0, 0.3);  // in single precision 0.30000001
    EXPECT_EQ(removed_from(field, 0), 0.0);
    field.height[1] = std::nextafter(field.height[1], 0.0);
    EXPECT_EQ(removed_from(field, 1), 0.0);
    field.height[2] = 0.1;
    EXPECT_NEAR(removed_from(field, 2), 0.2, 1e-7);
    field.height[3] = -0.1;
    EXPECT_NEAR(removed_from(field, 3), 0.4, 1e-7);
    field.height[4] = 0.31;
    EXPECT_EQ(removed_from(field, 4), 0.0);
}

TEST_F(HeightFieldFile, AFailedWriteNamesThePathAndLeavesTheOldFile) {
    const HeightField field = testing::plate(2.0, 2.0, 1.0);
    write_hdf5(field, path_, "");
    const std::string before = bytes();
    try {
        write_hdf5(field, (folder_ / "no" / "such" / "x.h5").string(), "");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("x.h5"), std::string::npos);
    }
    EXPECT_EQ(bytes(), before);
}

TEST_F(HeightFieldFile, HasTheSameBytesWhereverItIsWritten) {
    const HeightField field = testing::plate(300.0, 300.0, 1.0, 0.2);  // arrays of several chunks
    write_hdf5(field, path_, "{}");
    const std::string whole = bytes();
    EXPECT_TRUE(hdf5_image(field, "{}") == whole);
    const int file = ::open(path_.c_str(), O_RDWR | O_TRUNC);
    EXPECT_FALSE(write_hdf5(field, file, "{}"));
    ::close(file);
    EXPECT_TRUE(bytes() == whole);
}

TEST_F(HeightFieldFile, AFullDiskIsToldAndNoFileStaysOpen) {
    const HeightField field = testing::plate(300.0, 300.0, 1.0, 0.2);
    const int full = ::open("/dev/full", O_RDWR);
    ASSERT_GE(full, 0);
    EXPECT_EQ(write_hdf5(field, full, "{}"), std::errc::no_space_on_device);
    ::close(full);
    write_hdf5(field, path_, "{}");
    EXPECT_EQ(read_hdf5(path_).height, field.height);
}

TEST_F(HeightFieldFile, RefusesAnythingElse) {
    EXPECT_THROW(read_hdf5((folder_ / "absent.h5").string()), InputError);
    overwrite("no HDF5 at all");
    EXPECT_THROW(read_hdf5(path_), InputError);
    const HeightField field = testing::plate(2.0, 2.0, 1.0);
    write_hdf5(field, path_, "");
    put("triangles", {1, 2}, H5T_NATIVE_UINT32, std::uint32_t{1000});
    EXPECT_THROW(read_hdf5(path_), InputError);
    write_hdf5(field, path_, "");
    put("height", {3}, H5T_NATIVE_DOUBLE, double{NAN});
    EXPECT_THROW(read_hdf5(path_), InputError);
    HeightField bad = field;
    bad.triangles.push_back({0, 1, 1000});
    EXPECT_THROW(write_hdf5(bad, path_, ""), std::logic_error);
    bad = field;
    bad.area.pop_back();
    EXPECT_THROW(write_hdf5(bad, path_, ""), std::logic_error);
}

TEST_F(HeightFieldFile, DamagedBytesAreRefusedOrReadButNeverCrash) {
    write_hdf5(testing::plate(3.0, 3.0, 1.0, 0.2), path_, "{}");
    const std::string good = bytes();
    std::mt19937 random(1);
    int refused = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::string bad = good;
        if (trial % 3 == 0) {
            bad.resize(random() % bad.size());
        } else {
            for (int k = 0; k < 8; ++k) bad[random() % 2048] = static_cast<char>(random());
        }
        overwrite(bad);
        try {
            const HeightField field = read_hdf5(path_);
            EXPECT_EQ(field.height.size(), field.size());
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace beltgrinding
