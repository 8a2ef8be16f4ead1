#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "beltgrinding/height_field.h"
#include "heightfield/sample_blocks.h"
#include "recorders/change_log.h"

namespace beltgrinding {

/// What a simulation did to the heights, step by step, to be played forwards and backwards. It
/// keeps the samples that changed, never whole fields: *frame* k is the state after the k-th block
/// of steps, frame 0 the state before all. A *key frame* is the sum of all frames since the last
/// key frame, so that any frame is reached from the start by few passes over the samples.
///
/// Bounded memory: when the frames hold more than `max_bytes`, each two become one, and from then
/// on a frame holds twice as many steps. Heights are float32, mm: what the field shows, not what
/// the next step would need.
class Recording {
  public:
    static constexpr std::size_t kMaxBytes = std::size_t{256} << 20;

    /// `max_bytes`: of the frames; the key frames come on top, and the start's heights.
    explicit Recording(std::size_t max_bytes = kMaxBytes);

    /// Begins a path of `duration` s at the end of the ones before: their time goes on. Throws
    /// InputError if the field has not the samples of the path before. `order`: the field's samples
    /// by position, as `SampleBlocks::samples`; what is kept are positions.
    void begin(const HeightField& field, double duration, std::span<const std::uint32_t> order);
    /// Adds a step that ends at `time` s since its path's begin and changed `changes`, ascending.
    void add_step(const SampleBlocks& blocks, std::span<const SampleBlocks::Change> changes,
                  double time);
    /// Ends the path.
    void end(const SampleBlocks& blocks);

    /// Where the path began: a part of another recording fits that began it there as well.
    struct Begin {
        std::size_t max_bytes, frames, steps_per_frame, steps;
        double offset;  // s
        bool operator==(const Begin&) const = default;
    };
    Begin begun() const { return {max_bytes_, last(), stride_, total_steps_, offset_}; }
    /// What was added since an earlier part.
    struct Part {
        bool whole = false;  // all frames: those before have become fewer
        ChangeLog log;
        std::vector<double> times;
        std::vector<std::uint32_t> steps;
        std::size_t stride = 1, pending_steps = 0, total_steps = 0;
        double pending_time = 0.0;
        std::vector<std::pair<std::uint32_t, std::uint64_t>> pending;  // block, its lanes

        /// Goes on with the part after this one.
        void append(const Part& next);
        std::size_t bytes() const;
    };
    /// The part after the one that ended with `frames` frames of `stride` steps.
    Part part_since(std::size_t frames, std::size_t stride) const;
    /// Goes on with the parts of a path, the first of which began where this path does.
    void restore(const SampleBlocks& blocks, std::span<const Part* const> parts);
    /// Forgets all; `simulate` does so when it is cancelled or fails.
    void clear();

    std::size_t samples() const { return start_.size(); }
    /// Number of the last frame.
    std::size_t last() const { return log_.blocks(); }
    std::size_t steps_per_frame() const { return stride_; }
    /// s when the frames are reached, `last() + 1` values; 0 first.
    const std::vector<double>& times() const { return times_; }
    /// Steps done until the frames, as `times`.
    const std::vector<std::uint32_t>& steps() const { return steps_; }
    double duration() const { return duration_; }
    /// The last frame that is reached at `time` s; 0 before the first.
    std::size_t frame_at(double time) const;
    std::size_t key_frames() const { return keys_.blocks(); }
    std::size_t changes() const { return log_.changes(); }
    /// Bytes held by all arrays.
    std::size_t bytes() const;

    /// Heights of all samples at a frame, mm. Throws InputError if there is no such frame.
    std::vector<float> heights_at(std::size_t frame) const;
    struct Changes {
        std::vector<std::uint32_t> sample;  ///< ascending
        std::vector<float> height;          ///< at the frame gone to, mm
    };
    /// The samples that may differ between two frames, in either order, with their heights at
    /// `to`. Throws InputError if there is no such frame.
    Changes advance(std::size_t from, std::size_t to) const;

  private:
    friend struct RecordingFile;
    void close_frame(const SampleBlocks& blocks);
    std::uint32_t sample_at(std::uint32_t position) const {
        return order_.empty() ? position : order_[position];
    }
    /// Key frames of the frames that have none yet.
    void make_key_frames();
    void halve();
    void check_frame(std::size_t frame) const;
    template <class Visit>
    void visit(std::size_t from, std::size_t to, Visit&& visit) const;

    std::size_t max_bytes_;
    std::vector<float> start_;            // by sample
    std::vector<std::uint32_t> order_;    // samples by position; empty: as they are numbered
    ChangeLog log_, keys_;                // by position
    std::vector<std::uint32_t> key_end_;  // frame of each key frame
    std::vector<double> times_;
    std::vector<std::uint32_t> steps_;
    std::size_t stride_ = 1;
    double duration_ = 0.0, offset_ = 0.0;
    // of the frame that is being filled
    std::vector<std::uint64_t> pending_;  // lanes by block
    std::vector<std::uint32_t> pending_blocks_;
    std::size_t pending_steps_ = 0, total_steps_ = 0;
    double pending_time_ = 0.0;
};

/// Writes a recording and `attributes` (a JSON text, may be empty) to an HDF5 file, atomically.
/// Throws InputError naming the path.
void write_hdf5(const Recording& recording, const std::string& path, const std::string& attributes);

/// The same bytes to an open, empty file, by its descriptor, as they are made. Returns why the file
/// did not take them all; what is there then is no recording. Throws InputError when memory does
/// not suffice.
std::error_code write_hdf5(const Recording& recording, int file, const std::string& attributes);

/// The same bytes. Throws InputError when memory does not suffice.
std::string hdf5_image(const Recording& recording, const std::string& attributes);

/// Reads what `write_hdf5` wrote; `attributes` may be null. Throws InputError naming the path, for
/// any file that is no sound recording.
Recording read_recording(const std::string& path, std::string* attributes = nullptr);

/// As `read_recording`, from a file's bytes; `name` is told in errors.
Recording read_recording_image(std::string_view image, const std::string& name,
                               std::string* attributes = nullptr);

}  // namespace beltgrinding
