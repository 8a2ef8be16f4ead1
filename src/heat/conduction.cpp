#include "heat/conduction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "heat/heat_rows.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
constexpr int kInnerRings = 3;  // that the heat may come to before a new zone is made
constexpr int kAside = 3;       // rings round the zone that know how near heat came
// alpha t over spacing^2: between sweeps; the longest part of a step, of which there are no more
// than so many; and where what comes in may all be taken at both ends.
constexpr double kUnit = 0.25;
constexpr double kPart = 1.0;
constexpr int kMostParts = 4;
constexpr double kBrief = 0.15;
constexpr std::array kSimpson = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
constexpr double kRounding = 1e-9;   // s: less is no time
constexpr float kLeastRise = 1e-3f;  // K: less is none

std::vector<float> depths(const ThermalNodes& nodes) {
    std::vector<float> found(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) found[k] = 1.0f / nodes.own[k].modes[0];
    return found;
}

}  // namespace

Conduction::Conduction(const PartHeat& part, int rings)
    : nodes_(part.nodes()),
      rings_(rings),
      material_(part.material()),
      diffusivity_(material_.diffusivity()),
      unit_(kUnit * nodes_.spacing * nodes_.spacing / diffusivity_),
      state_(part.state()),
      depth_(depths(nodes_)),
      layer_({nodes_.first, nodes_.neighbour, nodes_.conductance, nodes_.area, depth_,
              nodes_.dispersion},
             diffusivity_, state_.modes),
      coarse_(part),
      power_(nodes_.size(), 0.0),
      ring_(nodes_.size(), kOutside),
      next_ring_(nodes_.size(), kOutside),
      place_(nodes_.size(), 0),
      direct_(nodes_.size(), 0.0f),
      zone_time_(state_.time),
      last_sweep_(state_.time),
      changed_(nodes_.size(), 0),
      factors_(material_) {
    for (std::uint32_t k = 0; k < nodes_.size(); ++k)
        if (state_.warm[k] != 0) layer_.put(k, state_.time);
}

void Conduction::add(std::uint32_t node, double power) {
    if (!(power > 0.0)) return;
    if (power_[node] == 0.0) powered_.push_back(node);
    power_[node] += power;
}

void Conduction::advance(double duration, std::uint32_t motion) {
    if (!(duration > 0.0)) {
        for (const std::uint32_t k : powered_) power_[k] = 0.0;
        powered_.clear();
        return;
    }
    if (powered_.empty()) {
        idle(state_.time + duration);
        return;
    }
    if (state_.time > zone_time_) catch_up();
    state_.motion = motion;
    hottest_ = 0.0;
    const double longest = kPart * nodes_.spacing * nodes_.spacing / diffusivity_;
    const int parts =
        static_cast<int>(std::clamp(std::ceil(duration / longest), 1.0, double{kMostParts}));
    for (int part = 0; part < parts; ++part) {
        if (!zone_holds()) make_zone();
        heat(duration / parts);
        // What is outside the zone follows it.
        if (zone_time_ - last_sweep_ >= unit_) sweep();
    }
    for (const std::uint32_t k : powered_) power_[k] = 0.0;
    powered_.clear();
}

void Conduction::idle(double time) {
    if (time > state_.time + kRounding) state_.time = time;
    hottest_ = 0.0;
}

bool Conduction::zone_holds() const {
    if (zone_.nodes.empty()) return false;
    return std::all_of(powered_.begin(), powered_.end(),
                       [this](std::uint32_t k) { return ring_[k] <= kInnerRings; });
}

// Breadth first from the heat, through the ways and through thin sections.
void Conduction::find_zone(std::vector<std::uint32_t>& nodes, std::vector<std::uint32_t>& beside) {
    std::vector<std::uint32_t> found = powered_;
    for (const std::uint32_t k : powered_) next_ring_[k] = 0;
    std::size_t begin = 0;
    for (int r = 0; r < rings_ + 1 + kAside; ++r) {
        const auto reach = [&](std::uint32_t k) {
            if (k == ThermalNodes::kNone || next_ring_[k] != kOutside) return;
            next_ring_[k] = static_cast<std::uint8_t>(r + 1);
            found.push_back(k);
        };
        const std::size_t end = found.size();
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t node = found[k];
            reach(nodes_.opposite[node]);
            for (std::uint32_t e = nodes_.first[node]; e < nodes_.first[node + 1]; ++e)
                reach(nodes_.neighbour[e]);
        }
        begin = end;
    }
    for (const std::uint32_t k : found) {
        const int ring = next_ring_[k];
        if (ring <= rings_) {
            nodes.push_back(k);
            continue;
        }
        if (ring == rings_ + 1) beside.push_back(k);
        // So that ages rise evenly across the zone's border.
        state_.last[k] = std::max(state_.last[k], zone_time_ - zone_age(next_ring_[k]));
        changed_[k] = 1;
        next_ring_[k] = kOutside;
    }
    std::sort(nodes.begin(), nodes.end());
}

// The middle of what is heated, and the axes in which it lies.
void Conduction::place_heat() {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t k : powered_) middle += nodes_.point[k];
    middle /= static_cast<double>(powered_.size());
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    for (const std::uint32_t k : powered_) {
        const Vec3 way = nodes_.point[k] - middle;
        square += way * way.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(square);
    state_.place = Frame::Identity();
    state_.place.linear() = axes.eigenvectors();
    state_.place.translation() = middle;
    state_.half.setZero();
    for (const std::uint32_t k : powered_) {
        const Vec3 way = axes.eigenvectors().transpose() * (nodes_.point[k] - middle);
        state_.half = state_.half.cwiseMax(way.cwiseAbs());
    }
}

double Conduction::way(const Vec3& point) const {
    const Vec3 there = state_.place.linear().transpose() * (point - state_.place.translation());
    const double away = (there.cwiseAbs() - state_.half).cwiseMax(0.0).squaredNorm();
    return away / (4.0 * diffusivity_);
}

// Heat may have come nearer by the inner rings since.
double Conduction::zone_age(std::uint32_t ring) const {
    const double away = std::max(static_cast<double>(ring) - kInnerRings, 0.0) * nodes_.spacing;
    return away * away / (4.0 * diffusivity_);
}

void Conduction::make_zone() {
    std::vector<std::uint32_t> beside, nodes;
    find_zone(nodes, beside);
    put_beyond_back();
    leave_zone();
    ring_.swap(next_ring_);
    zone_.nodes.swap(nodes);
    beyond_.swap(beside);
    place_heat();
    place_zone();
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        const std::uint32_t k = zone_.nodes[i];
        float* row = &zone_rows_[i * kModes];
        std::copy_n(layer_.row(k), kModes, row);
        const double since = zone_time_ - layer_.current(k);
        if (layer_.has(k) && since > 0.0) decay_row(row, factors_(since).decay.data());
        layer_.lend(k);
    }
    take_beyond();
    coarse_.move(zone_time_, [this](const Vec3& point) { return way(point); });
    find_base();
}

void Conduction::place_zone() {
    const std::size_t all = zone_.nodes.size() + 2 * beyond_.size();
    zone_rows_.resize(all * kModes);
    zone_.slow.assign(all, 0);
    std::uint32_t place = 0;
    for (const auto* list : {&zone_.nodes, &beyond_})
        for (const std::uint32_t k : *list) place_[k] = place++;
    for (const std::uint32_t k : zone_.nodes)
        if (nodes_.opposite[k] != ThermalNodes::kNone) thin_.push_back(k);
    join_zone();
}

// After its nodes come those beyond, which stay as they are, and then once more, for what flows
// into them.
void Conduction::join_zone() {
    const auto add = [this](std::uint32_t other, double sign, std::uint32_t edge) {
        const HeatWay& way = layer_.ways()[edge];
        zone_.ways.push_back(
            {other, static_cast<float>(sign * way.rate), static_cast<float>(sign * way.mean_rate)});
        return static_cast<double>(std::max(way.rate, way.mean_rate));
    };
    const auto end = [this] {
        zone_.first.push_back(static_cast<std::uint32_t>(zone_.ways.size()));
    };
    end();
    for (const std::uint32_t k : zone_.nodes) {
        double sum = 0.0;
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e)
            sum += add(place_[nodes_.neighbour[e]], 1.0, e);
        zone_.most = std::max(zone_.most, sum);
        end();
    }
    for (std::size_t i = 0; i < beyond_.size(); ++i) end();
    for (const std::uint32_t k : beyond_) {
        for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
            if (!in_zone(nodes_.neighbour[e])) continue;
            add(place_[nodes_.neighbour[e]], 1.0, e);
            add(place_[k], -1.0, e);
        }
        end();
    }
}

void Conduction::put_beyond_back() {
    const std::size_t inside = zone_.nodes.size(), count = beyond_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const float* row = &zone_rows_[(inside + i) * kModes];
        const float* in = &zone_rows_[(inside + count + i) * kModes];
        float* back = layer_.row(beyond_[i]);
        for (std::size_t j = 0; j < kModes; ++j) back[j] = row[j] + in[j];
        layer_.current(beyond_[i]) = zone_time_;
    }
}

void Conduction::take_beyond() {
    const std::size_t inside = zone_.nodes.size(), count = beyond_.size();
    const double near = zone_time_ - zone_age(static_cast<std::uint32_t>(rings_) + 1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = beyond_[i];
        layer_.put(k, zone_time_);
        float* row = layer_.row(k);
        const double since = zone_time_ - layer_.current(k);
        if (since > 0.0) decay_row(row, factors_(since).decay.data());
        layer_.current(k) = zone_time_;
        state_.last[k] = std::max(state_.last[k], near);
        changed_[k] = 1;
        std::copy_n(row, kModes, &zone_rows_[(inside + i) * kModes]);
        std::fill_n(&zone_rows_[(inside + count + i) * kModes], kModes, 0.0f);
    }
}

void Conduction::leave_zone() {
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        const std::uint32_t k = zone_.nodes[i];
        std::copy_n(&zone_rows_[i * kModes], kModes, layer_.row(k));
        layer_.put(k, zone_time_);
        state_.last[k] = std::max(state_.last[k], zone_time_ - zone_age(ring_[k]));
        ring_[k] = kOutside;
        changed_[k] = 1;
    }
    zone_.clear();
    beyond_.clear();
    thin_.clear();
    base_.clear();
    slope_.clear();
}

void Conduction::forget_direct() {
    for (const std::uint32_t k : heated_) direct_[k] = 0.0f;
    heated_.clear();
}

void Conduction::inject(const Row& gain) {
    for (const std::uint32_t k : heated_)
        heat_row(&zone_rows_[place_[k] * kModes], gain.data(), nodes_.own[k].modes.data(), flux(k),
                 nodes_.other[k].modes.data(), flux(nodes_.opposite[k]));
}

float Conduction::flux(std::uint32_t node) const {
    return node == ThermalNodes::kNone ? 0.0f
                                       : static_cast<float>(power_[node] / nodes_.area[node]);
}

void Conduction::heat(double duration) {
    forget_direct();
    heated_ = powered_;
    for (const std::uint32_t k : thin_)
        if (power_[k] == 0.0 && power_[nodes_.opposite[k]] > 0.0) heated_.push_back(k);
    // What comes in is conducted along the surface as if it came at the beginning, in the middle
    // and in the end; in a short time, at beginning and end. Decay and conduction may change
    // places.
    const bool brief = diffusivity_ * duration <= kBrief * nodes_.spacing * nodes_.spacing;
    const std::size_t times = brief ? 2 : 3;
    const std::array<double, 3> shares = brief ? std::array{0.5, 0.5, 0.0} : kSimpson;
    decay_rows(zone_rows_.data(), zone_.slow.size(), factors_(duration).decay.data());
    double left = 1.0;
    const double between = duration / static_cast<double>(times - 1);
    for (std::size_t i = 0; i < times; ++i) {
        left -= shares[i];
        Row gain = factors_(shares[i] * duration).gain;
        const Row& decay = factors_(std::max(left, 0.0) * duration).decay;
        for (std::size_t j = 0; j < kModes; ++j) gain[j] *= decay[j];
        inject(gain);
        if (i + 1 < times)
            conductor_.conduct(zone_, between, nodes_.dispersion / (diffusivity_ * between),
                               zone_rows_);
    }
    zone_sums_.resize(zone_.nodes.size());
    sum_rows(zone_rows_.data(), zone_sums_.size(), zone_sums_.data());
    for (const std::uint32_t k : heated_) {
        direct_[k] =
            (nodes_.own[k].direct * flux(k) + nodes_.other[k].direct * flux(nodes_.opposite[k])) /
            static_cast<float>(material_.conductivity);
        zone_sums_[place_[k]] += direct_[k];
    }
    state_.time += duration;
    state_.heated = zone_time_ = state_.time;
    const auto since = static_cast<float>(zone_time_ - base_time_);
    for (std::size_t i = 0; i < base_.size(); ++i) zone_sums_[i] += base_[i] + since * slope_[i];
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        note_peak(zone_.nodes[i], zone_sums_[i]);
        if (zone_sums_[i] > hottest_) {
            hottest_ = zone_sums_[i];
            hottest_node_ = zone_.nodes[i];
        }
    }
}

double Conduction::rise(std::uint32_t node) const {
    const float* row = in_zone(node) ? &zone_rows_[place_[node] * kModes] : layer_.row(node);
    return double{sum_of_row(row)} + direct_[node] + coarse_.rise(node, zone_time_).rise;
}

void Conduction::note_peak(std::uint32_t node, float rise) {
    if (rise > std::max(state_.peak[node], kLeastRise)) {
        state_.peak[node] = rise;
        state_.source[node] = state_.motion;
        changed_[node] = 1;
    }
}

}  // namespace beltgrinding
