#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"

namespace beltgrinding {

/// The time series so far.
struct StepPart {
    Since<StepRecord> records;
    bool touched = false;  // as of now

    void append(const StepPart& next) {
        records.append(next.records);
        touched = next.touched;
    }
    std::size_t bytes() const { return sizeof(StepPart) + records.bytes(); }
};

/// Keeps the time series, and whether the wheel has touched the stock at all.
class StepRecorder final : public Keeps<StepPart, Recorder> {
  public:
    /// `must_touch`: a path that never touches is an error.
    explicit StepRecorder(bool must_touch) : Keeps(&PhaseTimes::events), must_touch_(must_touch) {}

    std::string kind() const override { return "time series"; }
    void begin_step(const StepTurn& turn) override;
    void touched(const Touch& touch) override;
    void end_step(const StepEnd& end) override;
    /// Throws InputError where it never touched and must.
    void end() override;
    void keep(HeightField&, SimulationResult& result) override;

  private:
    StepPart take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const StepPart* const> parts) override;

    bool must_touch_, touched_ = false;
    std::vector<StepRecord> records_;
    std::size_t given_ = 0;  // by `take`
};

}  // namespace beltgrinding
