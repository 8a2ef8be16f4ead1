#include <Standard_Failure.hxx>
#include <algorithm>

#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

constexpr double kChord = 2e-4;      // of the shape's size, of what sides are told by
constexpr double kTolerance = 5e-4;  // of it, between free edges that are one
constexpr double kAngle = 0.5;       // rad
constexpr std::size_t kMostRuns = 8;

/// Of faces from 0: "3 to 7, 9".
std::string face_list(const std::vector<std::size_t>& faces) {
    std::string text;
    std::size_t runs = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        std::size_t last = i;
        while (last + 1 < faces.size() && faces[last + 1] == faces[last] + 1) ++last;
        if (++runs > kMostRuns) return text + ", ...";
        if (!text.empty()) text += ", ";
        text += std::to_string(faces[i] + 1);
        if (last > i) text += (last > i + 1 ? "-" : ", ") + std::to_string(faces[last] + 1);
        i = last;
    }
    return text;
}

}  // namespace

const FaceSides& Shape::Impl::sides(const RunContext& context) const {
    const std::lock_guard<std::mutex> lock(sides_mutex);
    if (known_sides) return *known_sides;
    const auto count = solid_of_face.size();
    std::vector<char> loose(count, 0);
    for (std::size_t f = 0; f < count; ++f) loose[f] = solid_of_face[f] < 0 ? 1 : 0;
    FaceSides found;
    found.turned.assign(count, 0);
    found.doubtful = loose;
    if (std::find(loose.begin(), loose.end(), 1) != loose.end()) {
        try {
            const auto [meshed, tolerance] = mesh_for_sides(context);
            found = face_sides(meshed, loose, common_borders(meshed, tolerance), context);
        } catch (const InputError&) {
            // Without triangles nothing is told: the faces stay as they are given, in doubt.
        } catch (const Standard_Failure&) {
        }
    }
    known_sides = std::make_unique<FaceSides>(std::move(found));
    return *known_sides;
}

std::pair<TopoDS_Shape, double> Shape::Impl::mesh_for_sides(const RunContext& context) const {
    Box box;
    {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!extents) extents = std::make_unique<Box>(tight_extents(shape, name, foreign));
        box = *extents;
    }
    const double size = box.isEmpty() ? 1.0 : std::max(box.diagonal().norm(), 1e-6);
    return {mesh_in_reader(shape, {kChord * size, kAngle, false}, name, foreign, context),
            kTolerance * size};
}

std::vector<char> Shape::reversed(const RunContext& context) const {
    std::vector<char> result(face_count(), 0);
    const bool some_loose = std::find(impl_->solid_of_face.begin(), impl_->solid_of_face.end(),
                                      -1) != impl_->solid_of_face.end();
    if (some_loose) result = impl_->sides(context).turned;
    for (std::size_t f = 0; f < result.size(); ++f) {
        if (bounds_solid(f)) {
            result[f] = impl_->inside_out(f) ? 1 : 0;
        } else if (flipped_ && (*flipped_)[f] != 0) {
            result[f] = result[f] != 0 ? 0 : 1;
        }
    }
    return result;
}

std::vector<std::vector<std::size_t>> Shape::neighbours(const RunContext& context) const {
    std::vector<std::vector<std::size_t>> result(face_count());
    try {
        const auto [meshed, tolerance] = impl_->mesh_for_sides(context);
        for (const FaceBorder& border : common_borders(meshed, tolerance)) {
            if (border.a == border.b) continue;
            result[border.a].push_back(border.b);
            result[border.b].push_back(border.a);
        }
    } catch (const Standard_Failure& failure) {
        throw InputError("brep.not_triangulated", "the shape cannot be triangulated: {reason}",
                         {{"reason", failure.GetMessageString()}});
    }
    for (auto& faces : result) {
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }
    return result;
}

Shape Shape::flipped(bool all, const std::vector<std::size_t>& faces) const {
    auto flips = std::make_shared<std::vector<char>>(face_count(), all ? 1 : 0);
    for (const std::size_t face : faces) {
        if (face >= face_count())
            throw InputError("brep.no_such_face",
                             "{shape} has no face {face}; it has {count} faces",
                             {{"shape", impl_->name}, {"face", face + 1}, {"count", face_count()}});
        if (bounds_solid(face))
            throw InputError("brep.flip_of_solid",
                             "face {face} of {shape} bounds a solid, whose outside is known; only "
                             "loose faces can be flipped",
                             {{"face", face + 1}, {"shape", impl_->name}});
        (*flips)[face] = (*flips)[face] != 0 ? 0 : 1;
    }
    Shape result = *this;
    result.flipped_ = std::move(flips);
    return result;
}

std::vector<Fact> Shape::side_warnings(const RunContext& context) const {
    std::vector<std::size_t> turned, doubtful, against;
    std::vector<Fact> found;
    const FaceSides& sides = impl_->sides(context);
    for (std::size_t f = 0; f < face_count(); ++f) {
        if (bounds_solid(f)) continue;
        const bool flip = flipped_ && (*flipped_)[f] != 0;
        if (flip && sides.doubtful[f] == 0) against.push_back(f);
        if (flip) continue;
        if (sides.doubtful[f] != 0) doubtful.push_back(f);
        if (sides.turned[f] != 0) turned.push_back(f);
    }
    const auto tell = [&](const char* code, const char* text,
                          const std::vector<std::size_t>& faces) {
        if (!faces.empty())
            found.push_back({code, text, {{"shape", impl_->name}, {"faces", face_list(faces)}}});
    };
    tell("brep.turned",
         "{shape}: the loose faces {faces} are turned against the file, as their neighbours and "
         "what they enclose tell",
         turned);
    tell("brep.side_in_doubt",
         "{shape}: neighbours and what they enclose do not tell which side of the loose faces "
         "{faces} is outside; it is taken as the file gives it. Look at it, and flip them if they "
         "point into the part",
         doubtful);
    tell("brep.flipped_inwards",
         "{shape}: the loose faces {faces} are flipped as wanted, to the side that their "
         "neighbours and what they enclose tell to be inside",
         against);
    for (const FaceBorder& border : sides.contrary)
        found.push_back(
            {"brep.sides_contrary",
             "{shape}: no choice of sides fits the border of the faces {face} and {other}: look "
             "at both, and flip one if it points into the part",
             {{"shape", impl_->name}, {"face", border.a + 1}, {"other", border.b + 1}}});
    return found;
}

}  // namespace beltgrinding
