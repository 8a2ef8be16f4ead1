#include "face_sampler.h"

#include <BRep_Tool.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "base/large_memory.h"
#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "delaunay.h"
#include "face_lattice.h"
#include "face_surface.h"
#include "face_trim.h"
#include "sample_weights.h"

namespace beltgrinding {
namespace {

constexpr double kSingularJacobian = 1e-6;  // of the face's mean: no normal can be told
constexpr double kUnevenJacobian = 1.5;     // ratio within a triangle: its mean says little
constexpr int kImprovePasses = 6;
constexpr std::size_t kRowBlock = 8;
constexpr std::size_t kBandTriangles = 4;  // about, for each sample of the border
constexpr std::size_t kTriangleBlock = 1 << 16;

/// Builds one face step by step; each step reads what the ones before it made.
class FaceSampler {
  public:
    FaceSampler(const FaceRequest& request, const RunContext& context)
        : request_(request), context_(context) {}

    FaceSamples run() {
        const TrimCurves trim = collect_trim_curves(request_.face);
        surface_.surface = BRep_Tool::Surface(request_.face);
        surface_.spline = SplineSurface::of(surface_.surface);
        surface_.s0 = trim.u0, surface_.s1 = trim.u1;
        surface_.t0 = trim.v0, surface_.t1 = trim.v1;
        if (!(trim.u1 > trim.u0) || !(trim.v1 > trim.v0))
            throw InputError(
                "brep.empty_trim",
                "its trimming edges enclose nothing; repair the shape or leave the face out");
        const SurfaceMetric metric(surface_,
                                   {request_.spacing, request_.precision, request_.edge_spacing});
        if (!std::isfinite(metric.max_length() + metric.height()))
            throw InputError(
                "brep.surface_nan",
                "its surface evaluates to NaN; repair the shape or leave the face out");
        if (!(metric.max_length() > 0) || !(metric.height() > 0))
            throw InputError("brep.no_extent",
                             "its surface has no extent; repair the shape or leave the face out");
        singular_ = kSingularJacobian * metric.mean_jacobian();
        const double largest = std::max(metric.mean_length(), metric.height());
        grid_.x_scale = std::max(4.0, kGridHalf * (metric.mean_length() / largest));
        grid_.y_scale = std::max(4.0, kGridHalf * (metric.height() / largest)) / metric.height();
        boundary_ = sample_boundary(trim, surface_, metric, grid_, request_.spacing);
        const auto rows =
            static_cast<std::size_t>(std::max(1.0, std::round(metric.height() / request_.spacing)));
        SampleBudget unlimited;
        FaceLattice lattice(metric, grid_, boundary_, request_.spacing, rows,
                            request_.budget != nullptr ? *request_.budget : unlimited);
        lattice_ = &lattice;
        sign_ = (surface_.swap != request_.reverse) ? -1.0 : 1.0;
        place_samples(lattice, metric);
        lattice.settle(surface_, metric, grid_, boundary_, request_.spacing,
                       point_.data() + lattice_base_, context_);
        add_cells();
        add_band();
        fill_singular_normals(point_, flags_, triangles_, normal_);
        return finish();
    }

  private:
    std::uint32_t lattice_sample(std::uint32_t node) const { return lattice_base_ + node; }

    void place_samples(FaceLattice& lattice, const SurfaceMetric& metric) {
        lattice_base_ = static_cast<std::uint32_t>(boundary_.samples.size());
        const std::size_t n = lattice_base_ + lattice.size();
        resize_large(point_, n);
        resize_large(normal_, n);
        cross_ = make_large<double>(n);
        flags_.assign(n, 0);
        const auto put = [&](std::size_t i, const Vec3& point, const Vec3& cross, bool singular) {
            point_[i] = point;
            const double jacobian = cross.norm();
            if (!std::isfinite(jacobian + point.sum()))
                throw InputError(
                    "brep.surface_nan",
                    "its surface evaluates to NaN; repair the shape or leave the face out");
            cross_[i] = singular ? 0.0 : jacobian;
            if (singular || jacobian <= singular_) {
                flags_[i] |= kDegenerate;
                normal_[i] = Vec3f::Zero();
            } else {
                normal_[i] = (cross * (sign_ / jacobian)).cast<float>();
            }
        };
        for (std::uint32_t i = 0; i < lattice_base_; ++i) {
            const RawSample& s = boundary_.samples[i];
            put(i, s.point, s.cross, s.singular);
            if (s.on_boundary) flags_[i] |= kOnBoundary;
        }
        lattice.place(surface_, metric, context_, [&](std::uint32_t node, const SurfacePoint& p) {
            put(lattice_base_ + node, p.point, p.ds.cross(p.dt), p.singular);
        });
    }

    /// One triangle, counter-clockwise in (s, t), with its area in (s, t). The area on the surface
    /// is that times the mean Jacobian; where the Jacobian changes too fast for a mean (a pinched
    /// parametrisation), the flat triangle's.
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, double parameter_area) {
        const double low = std::min({cross_[a], cross_[b], cross_[c]});
        const double high = std::max({cross_[a], cross_[b], cross_[c]});
        double area = std::abs(parameter_area) * (cross_[a] + cross_[b] + cross_[c]) / 3.0;
        if (low > singular_ && high > kUnevenJacobian * low)
            area = (point_[b] - point_[a]).cross(point_[c] - point_[a]).norm() / 2.0;
        const std::array<double, 3> share = voronoi_shares(point_[a], point_[b], point_[c]);
        area_[a] += area * share[0];
        area_[b] += area * share[1];
        area_[c] += area * share[2];
        put_triangle(a, b, c);
    }

    void put_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a == b || b == c || c == a) return;  // a corner at a pole
        triangles_.push_back(sided(a, b, c));
    }

    Triangle sided(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return sign_ < 0 ? Triangle{a, c, b} : Triangle{a, b, c};
    }

    /// The whole cells between the rows j and j + 1, from left to right: visit(its lower left
    /// node, its upper left one).
    template <class Visit>
    void for_cells(std::size_t j, Visit visit) const {
        const auto& rows = lattice_->rows();
        if (j + 1 >= rows.size()) return;
        for (const auto& run : rows[j].runs) {
            std::uint32_t ahead = FaceLattice::kNone;
            for (int k = run.begin; k + 1 < run.end; ++k) {
                const std::uint32_t a = run.first + static_cast<std::uint32_t>(k - run.begin);
                if (!lattice_->whole(a)) {
                    ahead = FaceLattice::kNone;
                    continue;
                }
                ahead = ahead == FaceLattice::kNone ? lattice_->find(j + 1, k) : ahead + 1;
                visit(a, ahead);
            }
        }
    }

    /// The cells that are whole, as two triangles each, cut along the shorter diagonal. Each thread
    /// sums up the areas of its own rows' nodes, from the cells below and then from those above.
    void add_cells() {
        const auto& rows = lattice_->rows();
        const std::size_t n = point_.size();
        area_ = make_large<double>(n);
        std::fill_n(area_.get(), lattice_base_, 0.0);
        std::vector<std::size_t> first(rows.size() + 1, 0);  // triangle of each row's cells
        parallel_blocks(rows.size(), kRowBlock, context_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j)
                for_cells(j, [&](std::uint32_t, std::uint32_t) { first[j + 1] += 2; });
        });
        for (std::size_t j = 0; j < rows.size(); ++j) first[j + 1] += first[j];
        reserve_large(triangles_, first.back() + kBandTriangles * boundary_.samples.size());
        triangles_.resize(first.back());
        parallel_blocks(rows.size(), kRowBlock, context_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j) fill_row(j, first[j]);
        });
    }

    void fill_row(std::size_t j, std::size_t triangle) {
        const auto& rows = lattice_->rows();
        double* area = area_.get() + lattice_base_;
        for (const auto& run : rows[j].runs)
            std::fill(area + run.first, area + run.first + (run.end - run.begin), 0.0);
        // Nearly a parallelogram: a quarter for each corner.
        const auto quarter = [&](double dt, std::uint32_t a, std::uint32_t d) {
            const double *low = cross_.get() + lattice_sample(a),
                         *high = cross_.get() + lattice_sample(d);
            return dt *
                   ((lattice_->s(a + 1) - lattice_->s(a)) * (low[0] + low[1]) +
                    (lattice_->s(d + 1) - lattice_->s(d)) * (high[0] + high[1])) /
                   16.0;
        };
        if (j > 0) {
            const double dt = rows[j].t - rows[j - 1].t;
            for_cells(j - 1, [&](std::uint32_t a, std::uint32_t d) {
                const double share = quarter(dt, a, d);
                area[d] += share;
                area[d + 1] += share;
            });
        }
        if (j + 1 >= rows.size()) return;
        const double dt = rows[j + 1].t - rows[j].t;
        Triangle* out = triangles_.data() + triangle;
        for_cells(j, [&](std::uint32_t a, std::uint32_t d) {
            const double share = quarter(dt, a, d);
            area[a] += share;
            area[a + 1] += share;
            const std::uint32_t sa = lattice_sample(a), sd = lattice_sample(d);
            if ((point_[sa] - point_[sd + 1]).squaredNorm() <=
                (point_[sa + 1] - point_[sd]).squaredNorm()) {
                *out++ = sided(sa, sa + 1, sd + 1);
                *out++ = sided(sa, sd + 1, sd);
            } else {
                *out++ = sided(sa, sa + 1, sd);
                *out++ = sided(sa + 1, sd + 1, sd);
            }
        });
    }

    struct BandNode {
        std::uint32_t sample;
        double s, t;
    };

    /// What lies between the border and the whole cells: a constrained Delaunay triangulation.
    void add_band() {
        std::vector<GridPoint> points;
        std::vector<BandNode> nodes;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> chains;
        for (const auto& n : boundary_.nodes) {
            points.push_back(n.grid);
            nodes.push_back({n.sample, n.s, n.t});
        }
        for (const auto& s : boundary_.segments) chains.push_back({s.a, s.b});
        add_lattice_border(points, nodes, chains);
        context_.throw_if_cancelled();

        Delaunay delaunay(points);
        bool sound = true;
        for (const auto& [a, b] : chains) sound &= delaunay.constrain(a, b);
        const std::vector<char> inside = classify(delaunay, points, sound);
        improve(delaunay, nodes, inside);
        const auto& faces = delaunay.faces();
        for (std::size_t f = 0; f < faces.size(); ++f) {
            if (!inside[f]) continue;
            const BandNode &a = nodes[Delaunay::point(faces[f], 0)],
                           &b = nodes[Delaunay::point(faces[f], 1)],
                           &c = nodes[Delaunay::point(faces[f], 2)];
            add_triangle(a.sample, b.sample, c.sample,
                         0.5 * ((b.s - a.s) * (c.t - a.t) - (b.t - a.t) * (c.s - a.s)));
        }
    }

    void add_lattice_border(std::vector<GridPoint>& points, std::vector<BandNode>& nodes,
                            std::vector<std::pair<std::uint32_t, std::uint32_t>>& chains) const {
        const auto& rows = lattice_->rows();
        constexpr std::uint32_t none = FaceLattice::kNone;
        std::vector<std::uint32_t> band(lattice_->size(), none);
        const auto whole = [&](std::size_t j, int k) {
            if (j + 1 >= rows.size()) return false;
            const std::uint32_t node = lattice_->find(j, k);
            return node != none && lattice_->whole(node);
        };
        for (std::size_t j = 1; j + 1 < rows.size(); ++j) {
            const auto& row = rows[j];
            for (const auto& run : row.runs) {
                bool left_above = whole(j, run.begin - 1), left_below = whole(j - 1, run.begin - 1);
                // Rows of another n have no cells between them, whatever their columns are.
                left_below = left_below && rows[j - 1].n == row.n;
                for (int k = run.begin; k < run.end; ++k) {
                    const std::uint32_t node =
                        run.first + static_cast<std::uint32_t>(k - run.begin);
                    const bool above = lattice_->whole(node);
                    const bool below = rows[j - 1].n == row.n && whole(j - 1, k);
                    if (lattice_->alive(node) && !(above && below && left_above && left_below)) {
                        band[node] = static_cast<std::uint32_t>(points.size());
                        points.push_back(grid_.point(double(k) / row.n, row.y));
                        nodes.push_back({lattice_sample(node), lattice_->s(node), row.t});
                    }
                    left_above = above;
                    left_below = below;
                }
            }
        }
        for (std::size_t j = 1; j + 1 < rows.size(); ++j) {
            const bool joined_below = rows[j - 1].n == rows[j].n;
            for (const auto& run : rows[j].runs) {
                for (int k = run.begin; k < run.end; ++k) {
                    const std::uint32_t node =
                        run.first + static_cast<std::uint32_t>(k - run.begin);
                    if (band[node] == none) continue;
                    const bool above = lattice_->whole(node);
                    if (above != (joined_below && whole(j - 1, k)))
                        chains.push_back({band[node], band[node + 1]});
                    if (above != whole(j, k - 1))
                        chains.push_back({band[node], band[lattice_->find(j + 1, k)]});
                }
            }
        }
    }

    /// For each triangle: inside the border and not in a whole cell.
    std::vector<char> classify(const Delaunay& delaunay, const std::vector<GridPoint>& points,
                               bool sound) const {
        const auto& faces = delaunay.faces();
        const std::size_t bins = std::max<std::size_t>(lattice_->rows().size(), 16);
        const TrimScan scan(boundary_, kGridHalf, bins);
        const auto wanted = [&](const Delaunay::Face& f) {
            double x = 0, y = 0;
            for (int i = 0; i < 3; ++i) {
                const GridPoint& p = points[Delaunay::point(f, i)];
                x += p.x / 3.0;
                y += p.y / 3.0;
            }
            return scan.inside(x, y) && !lattice_->in_whole_cell(x, y, grid_);
        };
        std::vector<char> result(faces.size(), 0), seen(faces.size(), 0);
        std::vector<Delaunay::Index> region;
        for (Delaunay::Index seed = 0; seed < faces.size(); ++seed) {
            if (seen[seed]) continue;
            // A region between constraints is inside or outside as a whole: ask its largest
            // triangle, the safest one.
            region.assign(1, seed);
            seen[seed] = 1;
            bool outer = false;
            std::int64_t largest = 0;
            Delaunay::Index representative = seed;
            for (std::size_t i = 0; i < region.size(); ++i) {
                const auto& f = faces[region[i]];
                if (!Delaunay::inner(f)) {
                    outer = true;
                } else {
                    const std::int64_t size =
                        orient(points[Delaunay::point(f, 0)], points[Delaunay::point(f, 1)],
                               points[Delaunay::point(f, 2)]);
                    if (size > largest) largest = size, representative = region[i];
                }
                for (std::size_t k = 0; sound && k < 3; ++k) {
                    if (f.n[k] == Delaunay::kNone || (f.fixed >> k & 1) || seen[f.n[k]]) continue;
                    seen[f.n[k]] = 1;
                    region.push_back(f.n[k]);
                }
            }
            if (outer || !wanted(faces[representative])) continue;
            for (const Delaunay::Index f : region) result[f] = 1;
        }
        return result;
    }

    /// The plane is only nearly isometric: flip to what is Delaunay on the surface itself.
    void improve(Delaunay& delaunay, const std::vector<BandNode>& nodes,
                 const std::vector<char>& inside) const {
        const auto* first = delaunay.faces().data();
        const auto usable = [&](const Delaunay::Face& f) { return inside[&f - first] != 0; };
        const auto better = [&](Delaunay::Index ia, Delaunay::Index ib, Delaunay::Index ic,
                                Delaunay::Index id) {
            const std::uint32_t sa = nodes[ia].sample, sb = nodes[ib].sample, sc = nodes[ic].sample,
                                sd = nodes[id].sample;
            if (sa == sb || sa == sc || sa == sd || sb == sc || sb == sd || sc == sd) return false;
            const Vec3 &a = point_[sa], &b = point_[sb], &c = point_[sc], &d = point_[sd];
            const Vec3 normal =
                sign_ * (normal_[sa] + normal_[sb] + normal_[sc] + normal_[sd]).cast<double>();
            // a, c, b, d run counter-clockwise.
            const auto up = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
                return (q - p).cross(r - p).dot(normal);
            };
            const double now = std::min(up(a, c, b), up(a, b, d));
            const double then = std::min(up(c, d, a), up(d, c, b));
            if (then <= 0 || now <= 0) return then > now;
            const auto cotangent = [](const Vec3& p, const Vec3& q, const Vec3& apex) {
                const Vec3 u = p - apex, v = q - apex;
                return u.dot(v) / std::max(u.cross(v).norm(), 1e-300);
            };
            // Delaunay: the angles opposite to a-b sum to at most pi. The margin keeps squares.
            return cotangent(a, b, c) + cotangent(a, b, d) < -1e-3;
        };
        delaunay.improve(usable, better, kImprovePasses);
    }

    /// u and v of all samples, in their order before those without area are dropped.
    std::vector<std::array<double, 2>> parameters(std::size_t samples) const {
        std::vector<std::array<double, 2>> result(samples);
        const auto put = [&](std::size_t i, double s, double t) {
            result[i] = surface_.swap ? std::array{t, s} : std::array{s, t};
        };
        for (const auto& node : boundary_.nodes) put(node.sample, node.s, node.t);
        for (const auto& row : lattice_->rows())
            for (const auto& run : row.runs)
                for (int k = run.begin; k < run.end; ++k) {
                    const std::uint32_t node =
                        run.first + static_cast<std::uint32_t>(k - run.begin);
                    put(lattice_sample(node), lattice_->s(node), row.t);
                }
        return result;
    }

    /// How far u and v go until the surface meets itself; 0 where it does not.
    std::array<double, 2> period() const {
        const auto& surface = surface_.surface;
        double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
        surface->Bounds(u0, u1, v0, v1);
        return {surface->IsUPeriodic() ? surface->UPeriod()
                : surface->IsUClosed() ? u1 - u0
                                       : 0.0,
                surface->IsVPeriodic() ? surface->VPeriod()
                : surface->IsVClosed() ? v1 - v0
                                       : 0.0};
    }

    /// Keeps the samples that carry area, scales to the exact area.
    FaceSamples finish() {
        FaceSamples out;
        std::vector<std::uint32_t> index(point_.size(), FaceLattice::kNone);
        std::vector<char> used(point_.size(), 0);
        for (const Triangle& t : triangles_) used[t[0]] = used[t[1]] = used[t[2]] = 1;
        double total = 0;
        std::size_t count = 0;
        if (triangles_.empty()) {
            // Smaller than its samples' resolution: the border's samples share the area.
            for (std::uint32_t i = 0; i < lattice_base_; ++i) used[i] = 1, area_[i] = 1.0;
        }
        for (std::uint32_t i = 0; i < point_.size(); ++i) {
            if (!used[i]) continue;
            index[i] = static_cast<std::uint32_t>(count++);
            total += area_[i];
        }
        out.sampled_area = triangles_.empty() ? request_.area : total;
        if (!(total > 0))
            throw InputError(
                "brep.empty_trim",
                "its trimming edges enclose nothing; repair the shape or leave the face out");
        const double scale = request_.area / total;
        resize_large(out.area, count);
        for (std::uint32_t i = 0; i < point_.size(); ++i) {
            const std::uint32_t k = index[i];  // never above i: in place
            if (k == FaceLattice::kNone) continue;
            point_[k] = point_[i];
            normal_[k] = normal_[i];
            out.area[k] = static_cast<float>(area_[i] * scale);
            flags_[k] = flags_[i];
        }
        const std::size_t all_samples = point_.size();
        point_.resize(count);
        normal_.resize(count);
        flags_.resize(count);
        out.point = std::move(point_);
        out.normal = std::move(normal_);
        out.flags = std::move(flags_);
        if (request_.parameters) {
            const auto all = parameters(all_samples);
            out.parameters.resize(count);
            for (std::uint32_t i = 0; i < all_samples; ++i)
                if (index[i] != FaceLattice::kNone) out.parameters[index[i]] = all[i];
            out.period = period();
        }
        parallel_blocks(triangles_.size(), kTriangleBlock, context_,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t i = begin; i < end; ++i)
                                for (std::uint32_t& v : triangles_[i]) v = index[v];
                        });
        out.triangles = std::move(triangles_);
        return out;
    }

    const FaceRequest& request_;
    const RunContext& context_;
    FaceSurface surface_;
    PlaneGrid grid_;
    Boundary boundary_;
    const FaceLattice* lattice_ = nullptr;
    double sign_ = 1, singular_ = 0;
    std::uint32_t lattice_base_ = 0;
    std::vector<Vec3> point_;
    std::vector<Vec3f> normal_;
    std::unique_ptr<double[]> cross_, area_;  ///< Jacobian; area before scaling
    std::vector<std::uint8_t> flags_;
    std::vector<Triangle> triangles_;
};

}  // namespace

FaceSamples sample_face(const FaceRequest& request, const RunContext& context) {
    return FaceSampler(request, context).run();
}

}  // namespace beltgrinding
