#include "face_sides.h"

#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "beltgrinding/geometry.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kAllSamples = 2000;  // over all pieces: each sums up all triangles
constexpr std::size_t kMostSamples = 64;   // of a piece
constexpr std::size_t kLeastSamples = 4;
constexpr std::size_t kAllChoices = 12;  // pieces; of more, not every choice of sides is tried
// Twice the winding number at the surface is 1 outwards of what closes, -1 inwards, near 0 of a
// sheet. A bare concave sheet looks inwards, too: it must hardly leave an opening to be turned.
constexpr double kTold = 0.5;
constexpr double kCloses = 0.9;
constexpr double kContrary = 0.05;  // of a face's own borders' length: worth a warning

struct Piece {
    std::vector<std::uint32_t> triangles;
    double area = 0;
    bool mixed = false;  ///< its faces, as given, disagree
};

struct Corners {
    std::array<Vec3, 3> p;
    std::uint32_t face;
    double area;
};

std::vector<Corners> triangles_of_loose(const TopoDS_Shape& meshed,
                                        const std::vector<char>& loose) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(meshed, TopAbs_FACE, faces);
    std::vector<Corners> found;
    for (int f = 1; f <= faces.Extent(); ++f) {
        if (loose[static_cast<std::size_t>(f - 1)] == 0) continue;
        const TopoDS_Face& face = TopoDS::Face(faces(f));
        TopLoc_Location location;
        const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, location);
        if (part.IsNull()) continue;
        const gp_Trsf& move = location.Transformation();
        const bool flip = (face.Orientation() == TopAbs_REVERSED) != move.IsNegative();
        for (int i = 1; i <= part->NbTriangles(); ++i) {
            std::array<int, 3> n{};
            part->Triangle(i).Get(n[0], n[1], n[2]);
            if (flip) std::swap(n[1], n[2]);
            Corners t{{}, static_cast<std::uint32_t>(f - 1), 0};
            for (std::size_t k = 0; k < 3; ++k) {
                const gp_Pnt p = part->Node(n[k]).Transformed(move);
                t.p[k] = Vec3(p.X(), p.Y(), p.Z());
            }
            t.area = 0.5 * (t.p[1] - t.p[0]).cross(t.p[2] - t.p[0]).norm();
            if (std::isfinite(t.area) && t.area > 0) found.push_back(t);
        }
    }
    return found;
}

/// Solid angle of a triangle over 4 pi, positive where its normal points away from the place (Van
/// Oosterom, Strackee, IEEE Trans. Biomed. Eng. 30, 1983).
double winding(const Corners& t, const Vec3& place) {
    const Vec3 a = t.p[0] - place, b = t.p[1] - place, c = t.p[2] - place;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double volume = a.dot(b.cross(c));
    const double rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    return std::atan2(volume, rest) / (2.0 * std::numbers::pi);
}

/// Faces that hang together, each turned or not against the lowest one.
class Neighbours {
  public:
    explicit Neighbours(std::size_t n) : parent_(n), turned_(n, 0) {
        for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint32_t>(i);
    }
    /// The lowest face of its set, and whether `face` is turned against it.
    std::pair<std::uint32_t, bool> find(std::uint32_t face) const {
        bool turned = false;
        while (parent_[face] != face) {
            turned ^= turned_[face] != 0;
            face = parent_[face];
        }
        return {face, turned};
    }
    /// False if they are known to be the other way.
    bool join(std::uint32_t a, std::uint32_t b, bool alike) {
        const auto [root_a, turned_a] = find(a);
        const auto [root_b, turned_b] = find(b);
        const bool turn = (turned_a != turned_b) == alike;
        if (root_a == root_b) return !turn;
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
        turned_[std::max(root_a, root_b)] = turn ? 1 : 0;
        return true;
    }

  private:
    std::vector<std::uint32_t> parent_;
    std::vector<char> turned_;
};

/// Twice the winding number of each piece, by column, at the surface of each, by row.
std::vector<std::vector<double>> windings(const std::vector<Piece>& pieces,
                                          const std::vector<Corners>& triangles,
                                          const std::vector<std::uint32_t>& piece_of,
                                          const std::vector<char>& turned,
                                          const RunContext& context) {
    const std::size_t n = pieces.size();
    const std::size_t each = std::clamp(kAllSamples / n, kLeastSamples, kMostSamples);
    std::vector<std::vector<double>> result(n, std::vector<double>(n, 0.0));
    std::vector<std::vector<double>> sums(n * each);
    parallel_blocks(n * each, 1, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Piece& piece = pieces[s / each];
            double rest = (double(s % each) + 0.5) / double(each) * piece.area;
            std::uint32_t own = piece.triangles.back();
            for (const std::uint32_t t : piece.triangles)
                if ((rest -= triangles[t].area) <= 0) {
                    own = t;
                    break;
                }
            const auto& p = triangles[own].p;
            const Vec3 place = (p[0] + p[1] + p[2]) / 3.0;
            sums[s].assign(n, 0.0);
            for (std::size_t t = 0; t < triangles.size(); ++t) {
                if (t == own) continue;
                const double w = 2.0 * winding(triangles[t], place);
                sums[s][piece_of[t]] += turned[triangles[t].face] != 0 ? -w : w;
            }
        }
    });
    for (std::size_t s = 0; s < sums.size(); ++s)
        for (std::size_t j = 0; j < n; ++j) result[s / each][j] += sums[s][j] / double(each);
    return result;
}

/// How far the pieces, turned by the signs, are from winding once round what is inside.
double misfit(const std::vector<Piece>& pieces, const std::vector<std::vector<double>>& w,
              const std::vector<double>& sign) {
    double sum = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        double total = -1.0;
        for (std::size_t j = 0; j < pieces.size(); ++j) total += sign[j] * w[i][j];
        sum += pieces[i].area * total * total;
    }
    return sum;
}

std::vector<double> best_signs(const std::vector<Piece>& pieces,
                               const std::vector<std::vector<double>>& w) {
    const std::size_t n = pieces.size();
    std::vector<double> best(n, 1.0);
    double least = misfit(pieces, w, best);
    if (n <= kAllChoices) {
        for (std::size_t choice = 1; choice < (std::size_t{1} << n); ++choice) {
            std::vector<double> sign(n);
            for (std::size_t i = 0; i < n; ++i) sign[i] = (choice >> i & 1U) != 0 ? -1.0 : 1.0;
            const double value = misfit(pieces, w, sign);
            if (value < least) least = value, best = sign;
        }
        return best;
    }
    for (std::size_t i = 0; i < n; ++i) best[i] = w[i][i] < -kTold ? -1.0 : 1.0;
    least = misfit(pieces, w, best);
    for (bool better = true; better;) {
        better = false;
        for (std::size_t i = 0; i < n; ++i) {
            best[i] = -best[i];
            const double value = misfit(pieces, w, best);
            if (value < least) {
                least = value;
                better = true;
            } else {
                best[i] = -best[i];
            }
        }
    }
    return best;
}

/// Joins the loose faces that meet at judged borders. `contrary`: the borders of some length that
/// say otherwise than those before.
Neighbours joined(const std::vector<char>& loose, const std::vector<FaceBorder>& borders,
                  std::vector<FaceBorder>& contrary) {
    Neighbours neighbours(loose.size());
    for (const FaceBorder& border : borders) {
        if (!border.judged || loose[border.a] == 0 || loose[border.b] == 0) continue;
        if (!neighbours.join(border.a, border.b, border.alike)) contrary.push_back(border);
    }
    std::vector<double> own(loose.size(), 0.0);  // length of a face's borders with loose ones, mm
    for (const FaceBorder& border : borders)
        own[border.a] += border.length, own[border.b] += border.length;
    std::erase_if(contrary, [&](const FaceBorder& border) {
        return border.length < kContrary * std::min(own[border.a], own[border.b]);
    });
    return neighbours;
}

/// Faces that are turned so that what hangs together is as most of its area is given.
std::vector<char> turned_as_most(const Neighbours& neighbours, const std::vector<double>& area) {
    const auto count = static_cast<std::uint32_t>(area.size());
    std::vector<double> whole(count, 0.0), against(count, 0.0);  // mm2, by the piece's lowest face
    for (std::uint32_t f = 0; f < count; ++f) {
        const auto [root, turned] = neighbours.find(f);
        whole[root] += area[f];
        if (turned) against[root] += area[f];
    }
    std::vector<char> turn(count, 0);
    for (std::uint32_t f = 0; f < count; ++f) {
        const auto [root, turned] = neighbours.find(f);
        turn[f] = turned != (against[root] > 0.5 * whole[root]) ? 1 : 0;
    }
    return turn;
}

/// The loose faces in pieces that hang together.
struct Pieces {
    std::vector<Piece> all;
    std::vector<std::uint32_t> of_face;  ///< of a loose one
    std::vector<std::uint32_t> of_triangle;

    Pieces(const std::vector<char>& loose, const Neighbours& neighbours,
           const std::vector<double>& area, const std::vector<Corners>& triangles);
    /// Leaves out pieces without triangles. Their faces belong to any.
    void drop_empty();
};

Pieces::Pieces(const std::vector<char>& loose, const Neighbours& neighbours,
               const std::vector<double>& area, const std::vector<Corners>& triangles)
    : of_face(loose.size(), 0) {
    for (std::uint32_t f = 0; f < loose.size(); ++f) {
        if (loose[f] == 0) continue;
        const auto [root, turned] = neighbours.find(f);
        if (root == f) {
            of_face[f] = static_cast<std::uint32_t>(all.size());
            all.emplace_back();
        }
        of_face[f] = of_face[root];
        all[of_face[f]].area += area[f];
        if (turned) all[of_face[f]].mixed = true;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        of_triangle.push_back(of_face[triangles[t].face]);
        all[of_triangle.back()].triangles.push_back(static_cast<std::uint32_t>(t));
    }
}

void Pieces::drop_empty() {
    std::vector<std::uint32_t> kept(all.size(), 0);
    std::vector<Piece> sound;
    for (std::size_t i = 0; i < all.size(); ++i) {
        kept[i] = static_cast<std::uint32_t>(sound.size());
        if (!all[i].triangles.empty()) sound.push_back(std::move(all[i]));
    }
    all = std::move(sound);
    for (std::uint32_t& piece : of_face) piece = kept[piece];
    for (std::uint32_t& piece : of_triangle) piece = kept[piece];
}

/// By piece: it is to be turned; which way round it is could not be told.
struct Verdict {
    std::vector<char> turn, doubt;
};

Verdict judge(const std::vector<Piece>& pieces, const std::vector<std::vector<double>>& w) {
    std::vector<double> sign = best_signs(pieces, w);
    const double least = misfit(pieces, w, sign);
    Verdict verdict{std::vector<char>(pieces.size(), 0), std::vector<char>(pieces.size(), 0)};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        sign[i] = -sign[i];
        // 1 of what closes, 0 of a flat sheet.
        const double told = 0.25 * (misfit(pieces, w, sign) - least) / pieces[i].area;
        sign[i] = -sign[i];
        const bool against_given = sign[i] < 0;
        const bool doubt = told < (against_given && !pieces[i].mixed ? kCloses : kTold);
        verdict.doubt[i] = doubt ? 1 : 0;
        verdict.turn[i] = against_given && !doubt ? 1 : 0;
    }
    return verdict;
}

}  // namespace

FaceSides face_sides(const TopoDS_Shape& meshed, const std::vector<char>& loose,
                     const std::vector<FaceBorder>& borders, const RunContext& context) {
    const std::size_t count = loose.size();
    FaceSides sides;
    sides.doubtful.assign(count, 0);
    const Neighbours neighbours = joined(loose, borders, sides.contrary);
    const std::vector<Corners> triangles = triangles_of_loose(meshed, loose);
    std::vector<double> area(count, 0.0);
    for (const Corners& t : triangles) area[t.face] += t.area;
    sides.turned = turned_as_most(neighbours, area);
    Pieces pieces(loose, neighbours, area, triangles);
    for (std::uint32_t f = 0; f < count; ++f)  // what has no triangles tells nothing
        if (loose[f] != 0 && pieces.all[pieces.of_face[f]].triangles.empty()) sides.doubtful[f] = 1;
    if (triangles.empty()) return sides;

    pieces.drop_empty();  // out of the sums: their area is 0
    const Verdict verdict = judge(
        pieces.all, windings(pieces.all, triangles, pieces.of_triangle, sides.turned, context));
    for (std::uint32_t f = 0; f < count; ++f) {
        if (loose[f] == 0 || sides.doubtful[f] != 0) continue;
        const std::uint32_t piece = pieces.of_face[f];
        if (verdict.turn[piece] != 0) sides.turned[f] = sides.turned[f] != 0 ? 0 : 1;
        sides.doubtful[f] = verdict.doubt[piece];
    }
    return sides;
}

}  // namespace beltgrinding
