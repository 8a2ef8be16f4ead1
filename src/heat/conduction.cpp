#include "heat/conduction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "beltgrinding/error.h"
#include "heat/heat_rows.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
constexpr int kInnerRings = 3;  // that the heat may come to before a new zone is made
constexpr int kAside = 3;       // rings round the zone that know how near heat came
// alpha t over spacing^2: between sweeps; the longest part of a step (with more of them than so
// many it is `dwell`'s); and where what comes in may all be taken at both ends.
constexpr double kUnit = 0.25;
constexpr double kPart = 1.0;
constexpr double kMostParts = 16.0;
constexpr double kBrief = 0.15;
constexpr std::array kSimpson = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
constexpr double kRounding = 1e-9;   // s: less is no time
constexpr float kLeastRise = 1e-3f;  // K: less is none
// What is no fault: of the bound, K beside it, and of the heat.
constexpr double kLongAgo = -1e30;  // s
constexpr double kMargin = 0.05;
constexpr double kFree = 0.5;
constexpr double kUnbalanced = 1e-3;

}  // namespace

Conduction::Conduction(const PartHeat& part, int rings, bool pulse)
    : part_(part),
      nodes_(part.nodes()),
      rings_(rings),
      material_(part.material()),
      diffusivity_(material_.diffusivity()),
      unit_(kUnit * nodes_.spacing * nodes_.spacing / diffusivity_),
      state_(part.state()),
      depth_(nodes_.depth()),
      sectional_(sectional_conductances(nodes_, depth_)),
      layer_({nodes_.first, nodes_.neighbour, nodes_.conductance, nodes_.area, depth_, sectional_,
              nodes_.spacing, nodes_.dispersion, part.levels().empty() ? &part : nullptr},
             diffusivity_, state_.modes),
      coarse_(part, !pulse),
      power_(nodes_.size(), 0.0),
      ring_(nodes_.size(), kOutside),
      next_ring_(nodes_.size(), kOutside),
      place_(nodes_.size(), 0),
      ended_(nodes_.size(), HUGE_VALF),
      direct_(nodes_.size(), 0.0f),
      zone_time_(state_.time),
      last_sweep_(state_.time),
      changed_(nodes_.size(), 0),
      factors_(material_, nodes_.longer, !pulse) {
    if (pulse) {
        std::fill(state_.modes.begin(), state_.modes.end(), 0.0f);
        std::fill(state_.last.begin(), state_.last.end(), kLongAgo);
        std::fill(state_.peak.begin(), state_.peak.end(), HUGE_VALF);  // which are not its own
        return;
    }
    for (std::uint32_t k = 0; k < nodes_.size(); ++k)
        if (state_.warm[k] != 0) layer_.put(k, state_.time);
}

void Conduction::add(std::uint32_t node, double power) {
    if (!(power > 0.0)) return;
    if (power_[node] == 0.0) powered_.push_back(node);
    power_[node] += power;
}

void Conduction::advance(double duration, std::uint32_t motion, double before) {
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
    hottest_ = lowest_ = 0.0;
    const double longest = kPart * nodes_.spacing * nodes_.spacing / diffusivity_;
    const double parts = std::max(std::ceil(duration / longest), 1.0);
    if (parts > kMostParts && rings_ <= kRings) {
        dwell(duration, motion);
    } else {
        state_.motion = motion;
        before_ = parts > 1.0 ? 0.0 : before;
        for (double part = 0.0; part < parts; ++part) {
            if (!zone_holds()) make_zone();
            heat(duration / parts);
            // What is outside the zone follows it.
            if (zone_time_ - last_sweep_ >= unit_) sweep();
        }
        keep_ended();
    }
    check_bounds();
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
    const std::size_t all = zone_.nodes.size() + beyond_.size();
    zone_rows_.resize(all * kModes);
    zone_.slow.assign(all, 0);
    std::uint32_t place = 0;
    for (const auto* list : {&zone_.nodes, &beyond_})
        for (const std::uint32_t k : *list) place_[k] = place++;
    for (const std::uint32_t k : zone_.nodes)
        if (nodes_.opposite[k] != ThermalNodes::kNone) thin_.push_back(k);
    join_zone();
}

// After its nodes come those beyond, with their ways into the zone: the others are the sweeps'. So
// each conducts what is conducted at all, to and fro alike, and none can run away.
void Conduction::join_zone() {
    zone_.first.push_back(0);
    for (const auto* list : {&zone_.nodes, &beyond_}) {
        for (const std::uint32_t k : *list) {
            double sum = 0.0;
            for (std::uint32_t e = nodes_.first[k]; e < nodes_.first[k + 1]; ++e) {
                if (list == &beyond_ && !in_zone(nodes_.neighbour[e])) continue;
                const HeatWay& way = layer_.ways()[e];
                zone_.ways.push_back({place_[way.other], way.rate, way.mean_rate});
                sum += std::max(way.rate, way.mean_rate);
            }
            zone_.first.push_back(static_cast<std::uint32_t>(zone_.ways.size()));
            zone_.most = std::max(zone_.most, sum);
        }
    }
}

void Conduction::put_beyond_back() {
    for (const std::uint32_t k : beyond_) {
        std::copy_n(&zone_rows_[place_[k] * kModes], kModes, layer_.row(k));
        layer_.current(k) = zone_time_;
    }
}

void Conduction::take_beyond() {
    const double near = zone_time_ - zone_age(static_cast<std::uint32_t>(rings_) + 1);
    for (const std::uint32_t k : beyond_) {
        layer_.put(k, zone_time_);
        float* row = layer_.row(k);
        const double since = zone_time_ - layer_.current(k);
        if (since > 0.0) decay_row(row, factors_(since).decay.data());
        layer_.current(k) = zone_time_;
        state_.last[k] = std::max(state_.last[k], near);
        changed_[k] = 1;
        std::copy_n(row, kModes, &zone_rows_[place_[k] * kModes]);
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

Conduction::Row Conduction::source(std::uint32_t node) const {
    const float one = flux(node), other = flux(nodes_.opposite[node]);
    Row found;
    for (std::size_t j = 0; j < kModes; ++j)
        found[j] = nodes_.own[node].modes[j] * one + nodes_.other[node].modes[j] * other;
    return found;
}

float Conduction::flux(std::uint32_t node) const {
    return node == ThermalNodes::kNone ? 0.0f
                                       : static_cast<float>(power_[node] / nodes_.area[node]);
}

// All rows are conducted between nodes, which makes none greater than the greatest; so none is
// greater than that of a node which always has the greatest flux.
void Conduction::account(double duration) {
    Row most{};
    float direct = 0.0f;
    double stored = 0.0;
    for (const std::uint32_t k : heated_) {
        const Row one = source(k);
        for (std::size_t j = 0; j < kModes; ++j) most[j] = std::max(most[j], std::abs(one[j]));
        direct_[k] =
            (nodes_.own[k].direct * flux(k) + nodes_.other[k].direct * flux(nodes_.opposite[k])) /
            static_cast<float>(material_.conductivity);
        direct = std::max(direct, direct_[k]);
        stored += double{nodes_.area[k]} * depth_[k] * one[0];
    }
    state_.flowed += stored * duration / material_.capacity();
    const Row& gain = factors_(duration).gain;
    double bound = direct;
    for (std::size_t j = 0; j < kModes; ++j) {
        state_.most[j] += double{most[j]} * gain[j];
        bound += state_.most[j];
    }
    state_.bound = std::max(state_.bound, bound);
}

void Conduction::decay_bound(double duration) {
    const Row& decay = factors_(duration).decay;
    for (std::size_t j = 0; j < kModes; ++j) state_.most[j] *= decay[j];
}

void Conduction::check_bounds() const {
    // Series and levels err by that much, at most.
    const double most = kMargin * state_.bound + kFree;
    if (hottest_ <= most + state_.bound && lowest_ >= -most) return;
    throw InputError(
        "heat.bound",
        "the computed heat makes no sense, a fault of this program: rises of "
        "{least:.4g} to {greatest:.4g} K, where {bound:.4g} K are the most that can be",
        {{"least", lowest_}, {"greatest", hottest_}, {"bound", state_.bound}});
}

void Conduction::check_energy() const {
    double stored = 0.0, sum = 0.0;
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
        stored += double{nodes_.area[k]} * depth_[k] * layer_.row(k)[0];
        sum += std::abs(sum_of_row(layer_.row(k)));
    }
    const double most = kUnbalanced * state_.flowed;
    if (std::abs(stored - state_.flowed) <= most && std::isfinite(sum)) return;
    const double joules = 1e-3 * material_.capacity();
    throw InputError(
        "heat.energy",
        "the computed heat makes no sense, a fault of this program: {stored:.5g} J are "
        "in the part, {flowed:.5g} J flowed in",
        {{"stored", joules * stored}, {"flowed", joules * state_.flowed}});
}

void Conduction::find_heated(const std::vector<std::uint32_t>& nodes) {
    forget_direct();
    heated_ = powered_;
    for (const std::uint32_t k : nodes)
        if (power_[k] == 0.0 && power_[nodes_.opposite[k]] > 0.0) heated_.push_back(k);
}

void Conduction::heat(double duration) {
    find_heated(thin_);
    decay_bound(duration);
    account(duration);
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
    for (const std::uint32_t k : heated_) zone_sums_[place_[k]] += direct_[k];
    state_.time += duration;
    state_.heated = zone_time_ = state_.time;
    const auto since = static_cast<float>(zone_time_ - base_time_);
    for (std::size_t i = 0; i < base_.size(); ++i) zone_sums_[i] += base_[i] + since * slope_[i];
    const auto share = static_cast<float>(before_);
    for (std::size_t i = 0; i < zone_.nodes.size(); ++i) {
        const float now = zone_sums_[i], ended = ended_[zone_.nodes[i]];
        note_now(zone_.nodes[i], ended < now ? now - share * (now - ended) : now);
    }
}

void Conduction::keep_ended() {
    for (const std::uint32_t k : last_) ended_[k] = HUGE_VALF;
    last_ = zone_.nodes;
    for (std::size_t i = 0; i < last_.size(); ++i) ended_[last_[i]] = zone_sums_[i];
}

void Conduction::note_ended() {
    for (const std::uint32_t k : last_) {
        note_peak(k, ended_[k]);
        ended_[k] = HUGE_VALF;
    }
    last_.clear();
}

void Conduction::note_now(std::uint32_t node, float rise) {
    note_peak(node, rise);
    lowest_ = std::min(lowest_, double{rise});
    if (rise <= hottest_) return;
    hottest_ = rise;  // or no number
    hottest_node_ = node;
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
