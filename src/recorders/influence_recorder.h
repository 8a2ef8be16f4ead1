#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// What an influence has collected since an earlier part, and the running motion as of now.
struct InfluencePart {
    std::vector<std::size_t> first;  // as of `Influence`, from its begin
    std::vector<std::uint32_t> sample;
    std::vector<float> depth;     // mm
    std::vector<float> feedback;  // 1/mm, of the motions that `first` closes
    std::uint32_t motion = 0;
    double felt = 0.0, looks = 0.0, parts = 0.0;  // as the collector has them
    std::vector<std::uint32_t> touched;
    std::vector<double> removed;  // mm, of those

    void append(const InfluencePart& next);
    std::size_t bytes() const;
};

/// Collects an influence during a simulation, whose motions come one after the other.
class InfluenceCollector : public Keeps<InfluencePart, Recorder> {
  protected:
    /// `motions`: of the path in all.
    InfluenceCollector(Phase phase, const SampleBlocks& blocks, std::size_t motions)
        : Keeps(phase), blocks_(blocks), motions_(motions), removed_(blocks.field().size(), 0.0) {}

    /// What comes is of that motion. They come one after the other.
    void go_on(std::uint32_t motion);
    /// The running motion has `amount` mm at a sample.
    void add(std::uint32_t sample, double amount);
    /// Of the parts that the running motion removes in: whether this one is to be looked at.
    bool due();
    /// The running motion has a feedback of `more` 1/mm, one look of several; their mean counts.
    void feel(double more);
    /// What has been collected. Call once.
    Influence collected();

    const SampleBlocks& blocks_;

  private:
    InfluencePart take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const InfluencePart* const> parts) override;
    void close(std::size_t motion);

    std::size_t motions_;
    Influence influence_;
    std::vector<double> removed_;         // mm, by the running motion
    std::vector<std::uint32_t> touched_;  // by the running motion
    std::uint32_t motion_ = 0;
    // Of the running motion: 1/mm, sum of the looks at its feedback; how many; parts since the
    // last.
    double felt_ = 0.0, looks_ = 0.0, parts_ = 0.0;
    std::size_t given_first_ = 1, given_entries_ = 0;  // by `take`
};

/// What every motion removes where, and how it answers what lies lower or higher than before.
class InfluenceRecorder final : public InfluenceCollector {
  public:
    InfluenceRecorder(const SampleBlocks& blocks, std::size_t motions, const RemovalLaw& law)
        : InfluenceCollector(&PhaseTimes::trace, blocks, motions), law_(law) {}

    std::string kind() const override { return "influence"; }
    void begin_step(const StepTurn& turn) override { step_motion_ = turn.step.pose; }
    void removed(const Removal& removal) override;
    void end_step(const StepEnd& end) override;
    void keep(HeightField&, SimulationResult& result) override { result.influence = collected(); }

  private:
    /// 1/mm, as of `Influence::feedback`; 0 where it is not known.
    double feedback(const Removal& removal) const;

    const RemovalLaw& law_;
    std::uint32_t step_motion_ = 0;  // of the running step
};

/// What every motion would remove more where by more force, per relative change.
class ForceInfluenceRecorder final : public InfluenceCollector {
  public:
    ForceInfluenceRecorder(const SampleBlocks& blocks, std::size_t motions, const RemovalLaw& law)
        : InfluenceCollector(&PhaseTimes::removal, blocks, motions), law_(law) {}

    std::string kind() const override { return "force influence"; }
    void begin_step(const StepTurn& turn) override { motion_ = turn.step.pose; }
    void removed(const Removal& removal) override;
    void keep(HeightField&, SimulationResult& result) override {
        result.force_influence = collected();
    }

  private:
    const RemovalLaw& law_;
    std::uint32_t motion_ = 0;         // of the running step
    Eigen::ArrayXd pressed_, beside_;  // mm/s, with more force
};

}  // namespace beltgrinding
