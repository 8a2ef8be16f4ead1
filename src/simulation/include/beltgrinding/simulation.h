#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "beltgrinding/run_context.h"
#include "beltgrinding/simulation_options.h"

namespace beltgrinding {

/// Grinds `field` along `path`: localise, gap, contact, removal, pose by pose. Only
/// `field.height`, `field.trace` and, where asked for, `field.heat` and `field.finish` change;
/// trace and finish go on with what is there. On cancel or error the field is left as it was before
/// the call. Results do not depend on the number of threads. Throws InputError (no contact anywhere
/// on the path, bad options) and Cancelled.
SimulationResult simulate(HeightField& field, const ToolPath& path, const ContactModel& model,
                          const RemovalLaw& law, const SimulationOptions& options,
                          const RunContext& context = {});

/// The contact at one programmed pose, on the field as it is.
struct PoseContact {
    ContactGrid grid;          ///< of the arrays below
    Eigen::ArrayXd gap;        ///< mm, radial, with the wheel where `placed` says; +inf: nothing
    Eigen::ArrayXd coverage;   ///< share of the cell that the workpiece covers
    ContactSolution solution;  ///< its approach counts from `placed`
    double placed = 0.0;       ///< mm along z from the programmed pose
    std::string model;         ///< what the contact model says of itself as it was used
    double commanded = 0.0;    ///< N; what is missing to it lies beyond the travel
};

/// Presses the wheel at the pose number `pose` (from 0) without grinding. Throws InputError if the
/// wheel does not touch there.
PoseContact contact_at(const HeightField& field, const ToolPath& path, std::size_t pose,
                       const ContactModel& model, const ProcessSettings& process,
                       const Resolution& resolution = {});

/// The same at several poses, each by itself; nothing where the wheel does not touch.
std::vector<std::optional<PoseContact>> contacts_at(const HeightField& field, const ToolPath& path,
                                                    const std::vector<std::size_t>& poses,
                                                    const ContactModel& model,
                                                    const ProcessSettings& process,
                                                    const Resolution& resolution = {},
                                                    const RunContext& context = {});

}  // namespace beltgrinding
