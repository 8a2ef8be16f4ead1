#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "contact_grid.h"
#include "engine/pressing.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

PoseContact contact_at(const HeightField& field, const ToolPath& path, std::size_t pose,
                       const ContactModel& model, const ProcessSettings& process,
                       const Resolution& resolution) {
    auto found = contacts_at(field, path, {pose}, model, process, resolution);
    if (!found.front()) {
        throw InputError("simulation.no_contact_at_pose",
                         "the wheel does not touch the stock at pose {pose}", {{"pose", pose + 1}});
    }
    return std::move(*found.front());
}

std::vector<std::optional<PoseContact>> contacts_at(const HeightField& field, const ToolPath& path,
                                                    const std::vector<std::size_t>& poses,
                                                    const ContactModel& model,
                                                    const ProcessSettings& process,
                                                    const Resolution& resolution,
                                                    const RunContext& context) {
    check_field(field);
    process.validate();
    resolution.validate();
    for (const std::size_t pose : poses) {
        if (pose >= path.poses().size()) {
            throw InputError("simulation.no_such_pose",
                             "there is no pose {pose}; the path has {count}",
                             {{"pose", pose + 1}, {"count", path.poses().size()}});
        }
    }
    if (model.rigid()) {
        throw InputError("simulation.rigid_pressure",
                         "a geometric (rigid) tool has no pressure; choose an elastic model");
    }
    const SampleBlocks blocks(field, context);
    std::vector<std::optional<PoseContact>> result;
    Pressing pressing(process, contact_cell(field, tool_envelope(process).wheel, resolution),
                      resolution.contact_tolerance, model, context);
    pressing.map().prepare(blocks);
    const auto untouched = pressing.snapshot({});
    const Snapshot* const begins = untouched.get();
    for (const std::size_t pose : poses) {
        context.throw_if_cancelled();
        pressing.restore({&begins, 1});  // a contact must not depend on the one before
        const PathPose& at = path.poses()[pose];
        PoseContact contact;
        contact.commanded = at.force >= 0.0 ? at.force : process.force;
        const auto state = pressing.press(blocks, path.frames().work_from_contact(at.base_from_tcp),
                                          contact.commanded);
        if (state == Pressing::State::kNoContact) {
            result.emplace_back();
            continue;
        }
        contact.grid = pressing.map().grid();
        contact.gap = pressing.map().gap();
        contact.coverage = pressing.map().coverage();
        contact.solution = pressing.solution();
        contact.model = pressing.describe();
        contact.placed = pressing.approach() - contact.solution.approach;
        result.push_back(std::move(contact));
    }
    return result;
}

}  // namespace beltgrinding
