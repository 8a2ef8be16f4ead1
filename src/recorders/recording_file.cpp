#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "beltgrinding/error.h"
#include "heightfield/hdf5_io.h"
#include "recorders/recording.h"

namespace beltgrinding {

using namespace hdf5;

namespace {
// Of the file; a reader refuses newer ones. Since 2 runs are positions, which `order` makes
// samples.
constexpr int kFormat = 2;
constexpr int kOldest = 1;
constexpr const char* kOrder = "order";

Fact within(const std::string& path) {
    return {"recording.file", "{file}: the recording ", {{"file", path}}};
}
}  // namespace

/// The only one that sees a recording's arrays. Key frames are no part of the file: they follow.
struct RecordingFile {
    static_assert(sizeof(ChangeLog::Run) == 2 * sizeof(std::uint32_t));
    static_assert(sizeof(ChangeLog::End) == 2 * sizeof(std::uint64_t));

    /// Calls visit(name, data, their type, values in a row) for all arrays.
    template <class Record, class Log, class Visit>
    static void each_array(Record& r, Log& log, Visit&& visit) {
        visit("start_height", r.start_, H5T_NATIVE_FLOAT, hsize_t{1});
        visit("run", log.runs, H5T_NATIVE_UINT32, hsize_t{2});
        visit("height", log.height, H5T_NATIVE_FLOAT, hsize_t{1});
        visit("frame_end", log.ends, H5T_NATIVE_UINT64, hsize_t{2});
        visit("time", r.times_, H5T_NATIVE_DOUBLE, hsize_t{1});
        visit("steps", r.steps_, H5T_NATIVE_UINT32, hsize_t{1});
    }

    /// The pieces of a log, as they follow one another.
    struct Pieces {
        std::vector<std::span<const ChangeLog::Run>> runs;
        std::vector<std::span<const float>> height;
        std::vector<ChangeLog::End> ends;
        explicit Pieces(const ChangeLog::Arrays& log)
            : runs{log.runs}, height{log.height}, ends(log.ends) {}
        explicit Pieces(const ChangeLog& log) {
            log.for_pieces([&](auto some_runs, auto heights, auto some_ends, auto before) {
                runs.push_back(some_runs);
                height.push_back(heights);
                for (const ChangeLog::End& end : some_ends)
                    ends.push_back({before.run + end.run, before.height + end.height});
            });
        }
    };

    static void write(const Recording& r, hid_t file, const std::string& attributes) {
        write_scalar(file, "recording_format", H5T_NATIVE_INT, &kFormat);
        write_scalar(file, "duration_s", H5T_NATIVE_DOUBLE, &r.duration_);
        const auto stride = static_cast<std::uint64_t>(r.stride_);
        write_scalar(file, "steps_per_frame", H5T_NATIVE_UINT64, &stride);
        const Pieces log(r.log_);
        try {
            check(r, log);
        } catch (const FileFault& fault) {
            throw std::logic_error("a recording that " +
                                   std::string(InputError(fault.fact).what()));
        }
        each_array(r, log, [&](const char* name, const auto& data, hid_t type, hsize_t row) {
            write_array(file, name, data, type, row);
        });
        write_array(file, kOrder, r.order_, H5T_NATIVE_UINT32, 1);
        write_text(file, "attributes", attributes);
    }

    static Recording read(std::unique_ptr<Storage> storage, std::string* attributes) {
        const InputFile file(std::move(storage), "recording_format", kFormat, kOldest);
        Recording r;
        std::uint64_t stride = 1;
        read_scalar(file, "duration_s", H5T_NATIVE_DOUBLE, &r.duration_);
        read_scalar(file, "steps_per_frame", H5T_NATIVE_UINT64, &stride);
        r.stride_ = static_cast<std::size_t>(stride);
        ChangeLog::Arrays log;
        each_array(r, log, [&](const char* name, auto& data, hid_t type, hsize_t row) {
            read_array(file, name, data, type, row);
        });
        if (H5Lexists(file, kOrder, H5P_DEFAULT) > 0)
            read_array(file, kOrder, r.order_, H5T_NATIVE_UINT32, 1);
        check(r, Pieces(log));
        r.log_ = ChangeLog(std::move(log));
        r.make_key_frames();
        r.total_steps_ = r.steps_.back();
        if (attributes != nullptr) *attributes = read_text(file, "attributes");
        return r;
    }

    /// What a file may hold: asked of what is read and of what is written. Throws FileFault.
    static void check(const Recording& r, const Pieces& log) {
        std::vector<bool> there(r.order_.size(), false);
        for (const std::uint32_t sample : r.order_) {
            require(sample < there.size() && !there[sample], "recording.order",
                    "has samples in no order");
            there[sample] = true;
        }
        require(r.order_.empty() || r.order_.size() == r.start_.size(), "recording.order",
                "has samples in no order");
        require(r.stride_ > 0 && std::isfinite(r.duration_), "recording.no_duration",
                "has no duration");
        require(r.times_.size() == log.ends.size() + 1 && r.steps_.size() == log.ends.size() + 1 &&
                    r.times_[0] == 0.0 && r.steps_[0] == 0 &&
                    std::all_of(r.times_.begin(), r.times_.end(),
                                [](double t) { return std::isfinite(t); }) &&
                    std::is_sorted(r.times_.begin(), r.times_.end()) &&
                    std::is_sorted(r.steps_.begin(), r.steps_.end()),
                "recording.no_time", "has frames without a time");
        std::size_t runs = 0, heights = 0, frame = 0;  // up to here
        for (const std::span<const ChangeLog::Run> some : log.runs) {
            for (const ChangeLog::Run& run : some) {
                for (; frame < log.ends.size() && log.ends[frame].run == runs; ++frame)
                    require(log.ends[frame].height == heights, "recording.cut_off",
                            "has a frame that is cut off");
                require(std::uint64_t{run.first} + run.count <= r.start_.size(),
                        "recording.no_such_sample", "names a sample that is not there");
                ++runs;
                heights += run.count;
            }
        }
        for (; frame < log.ends.size() && log.ends[frame].run == runs; ++frame)
            require(log.ends[frame].height == heights, "recording.cut_off",
                    "has a frame that is cut off");
        require(frame == log.ends.size(), "recording.cut_off", "has a frame that is cut off");
        std::size_t there_are = 0;
        for (const std::span<const float> some : log.height) there_are += some.size();
        require(heights == there_are && (frame == 0 ? runs == 0 : log.ends.back().run == runs),
                "recording.no_frame", "has heights of no frame");
        const auto finite = [](std::span<const float> some) {
            return std::all_of(some.begin(), some.end(), [](float h) { return std::isfinite(h); });
        };
        require(finite(r.start_) && std::all_of(log.height.begin(), log.height.end(), finite),
                "recording.height", "has a height that is not finite");
    }
};

namespace {
Writer writer(const Recording& recording, const std::string& attributes) {
    return [&](hid_t file) { RecordingFile::write(recording, file, attributes); };
}
}  // namespace

std::string hdf5_image(const Recording& recording, const std::string& attributes) {
    return locked(within("HDF5"),
                  [&] { return image_of(writer(recording, attributes), recording.bytes()); });
}

void write_hdf5(const Recording& recording, const std::string& path,
                const std::string& attributes) {
    locked(within(path), [&] { write_file(path, writer(recording, attributes)); });
}

std::error_code write_hdf5(const Recording& recording, int file, const std::string& attributes) {
    return locked(within("HDF5"), [&] { return write_into(file, writer(recording, attributes)); });
}

Recording read_recording(const std::string& path, std::string* attributes) {
    return locked(within(path), [&] {
        RegularFile file;
        open_regular(file, path);
        return RecordingFile::read(stored_in(file.number()), attributes);
    });
}

Recording read_recording_image(std::string_view image, const std::string& name,
                               std::string* attributes) {
    return locked(within(name), [&] { return RecordingFile::read(stored_in(image), attributes); });
}

}  // namespace beltgrinding
