#include "shift_recorder.h"

#include <utility>

#include "engine/grinding.h"

namespace beltgrinding {

ShiftRecorder::ShiftRecorder(const SampleBlocks& blocks, const Laws& laws,
                             const ProcessSettings& process)
    : Keeps(&PhaseTimes::removal),
      blocks_(blocks),
      laws_(laws),
      process_(process),
      shifts_(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(blocks.field().size()),
                                    static_cast<Eigen::Index>(laws.size()))) {}

std::string ShiftRecorder::kind() const {
    return "shifts of " + std::to_string(laws_.size()) + " laws";
}

void ShiftRecorder::removed(const Removal& removal) {
    const DisplacedPressure& pressure = removal.pressing.displaced_pressure();
    for (std::size_t k = 0; k < laws_.size(); ++k) {
        ProcessState state = removal.state;
        if (laws_[k].wear)
            state.belt_wear = process_.belt_wear * laws_[k].wear->remaining(removal.belt);
        rate_under(*laws_[k].law, pressure, state, rate_, beside_);
        auto shift = shifts_.col(static_cast<Eigen::Index>(k));
        removal.pressing.map().for_samples(removal.mean(rate_.min(removal.most)) - removal.rate,
                                           beside_.min(removal.most_beside) - removal.beside,
                                           removal.duration,
                                           [&](std::size_t position, double amount) {
                                               shift[blocks_.sample(position)] += amount;
                                           });
    }
}

void ShiftRecorder::keep(HeightField&, SimulationResult& result) {
    result.shifts = std::move(shifts_);
}

// Calls visit(lane, sample).
template <class Visit>
void ShiftRecorder::for_lanes(std::uint32_t block, Visit visit) const {
    const std::size_t first = std::size_t{block} * SampleBlocks::kLanes;
    for (std::size_t lane = 0; lane < SampleBlocks::kLanes; ++lane)
        if (first + lane < blocks_.samples().size())
            visit(static_cast<Eigen::Index>(lane),
                  static_cast<Eigen::Index>(blocks_.sample(first + lane)));
}

ByBlock<Eigen::ArrayXXd> ShiftRecorder::take(std::span<const std::uint32_t> blocks) {
    return {blocks, [this](std::uint32_t block) {
                Eigen::ArrayXXd values =
                    Eigen::ArrayXXd::Zero(SampleBlocks::kLanes, shifts_.cols());
                for_lanes(block, [&](Eigen::Index lane, Eigen::Index sample) {
                    values.row(lane) = shifts_.row(sample);
                });
                return values;
            }};
}

void ShiftRecorder::put(std::span<const ByBlock<Eigen::ArrayXXd>* const> parts) {
    for (const auto* part : parts) {
        part->each([this](std::uint32_t block, const Eigen::ArrayXXd& values) {
            for_lanes(block, [&](Eigen::Index lane, Eigen::Index sample) {
                shifts_.row(sample) = values.row(lane);
            });
        });
    }
}

}  // namespace beltgrinding
