#include "heat/coarse_heat.h"

#include <algorithm>
#include <cmath>

#include "heat/heat_rows.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kModes = DepthModes::kModes;
// alpha t over the spacing^2 of a level: between its steps; the age from which heat comes to it,
// and by when it all has come.
constexpr double kInterval = 0.5;
constexpr double kRipe = 1.25, kRipening = 5.0;

constexpr double kNever = -1e30;  // s
constexpr float kLeft = 0.025f;   // K: a rest of less, of each mode, is handed up as it is

/// What is left of what was young, at an age in `ripe`s.
double left(double age) {
    return std::clamp((kRipe + kRipening - age * kRipe) / kRipening, 0.0, 1.0);
}

/// Adds what of a finer row comes to `to`: `part` of it by area, of the first mode by the sections'
/// `depths`, one over the other, as well.
void add_part(float* to, float part, float depths, const float* row) {
    to[0] += part * depths * row[0];
    for (std::size_t j = 1; j < kModes; ++j) to[j] += part * row[j];
}

}  // namespace

bool CoarseHeat::little(const float* row) {
    return greatest_of_row(row) < kLeft;
}

CoarseHeat::Level::Level(const ThermalLevel& level, double diffusivity, double now,
                         const PartHeat* even)
    : place(level),
      rows(level.size() * kModes, 0.0f),
      layer({level.first, level.neighbour, level.conductance, level.area, level.depth,
             level.sectional, level.spacing, level.dispersion, even},
            diffusivity, rows),
      interval(kInterval * level.spacing * level.spacing / diffusivity),
      ripe(kRipe * level.spacing * level.spacing / diffusivity),
      time(now),
      before(now),
      last(level.size(), kNever),
      given(level.size()),
      visited(level.shares.size(), 0),
      own(level.size(), 0.0f),
      own_slope(level.size(), 0.0f),
      total(level.size(), 0.0f),
      total_slope(level.size(), 0.0f) {}

CoarseHeat::CoarseHeat(const PartHeat& part, bool decays)
    : part_(part),
      diffusivity_(part.material().diffusivity()),
      interval_(kInterval * std::pow(ThermalLevel::kCoarser * part.spacing(), 2) / diffusivity_),
      factors_(part.material(), part.nodes().longer, decays),
      stepped_(part.state().time) {}

void CoarseHeat::make(double now) {
    const auto& all = part_.levels();
    for (const ThermalLevel& level : all)
        levels_.push_back(std::make_unique<Level>(level, diffusivity_, now,
                                                  &level == &all.back() ? &part_ : nullptr));
}

void CoarseHeat::clear(double now) {
    levels_.clear();
    stepped_ = now;
}

bool CoarseHeat::empty() const {
    return levels_.empty();
}

double CoarseHeat::ripe() const {
    return kRipe / kInterval * interval_;
}

bool CoarseHeat::due(double now) const {
    return std::floor(now / interval_) != std::floor(stepped_ / interval_);
}

void CoarseHeat::step(double now, double heated, const Way& way, bool all) {
    if (levels_.empty()) make(stepped_);
    std::size_t count = 0;  // that are due: each has intervals of several of the one before
    for (const auto& level : levels_) {
        if (!all && std::floor(now / level->interval) == std::floor(level->time / level->interval))
            break;
        level->layer.conduct(now, now - level->time, factors_);
        level->before = level->time;
        level->time = now;
        ++count;
    }
    stepped_ = now;
    for (std::size_t m = 0; m + 1 < count; ++m) {
        Level &from = *levels_[m], &to = *levels_[m + 1];
        const auto kept_of = [&](std::uint32_t k) {
            const double age =
                std::min(now - from.last[k], now - heated + way(from.place.point[k]));
            return kept(to, age);
        };
        ripe_.clear();
        from.layer.list(old_);
        for (const std::uint32_t k : old_) {
            const float keep = kept_of(k);
            if (keep >= 1.0f) continue;
            const float* row = from.layer.row(k);
            if (keep == 0.0f) {
                ripe_.push_back(k);
                if (little(row)) continue;
            }
            Row moved;
            for (std::size_t j = 0; j < kModes; ++j) moved[j] = row[j] * (1.0f - keep);
            give(m + 1, k, from.place.area[k], from.place.depth[k], moved, from.last[k]);
        }
        take(m + 1, [&](std::uint32_t k, const Row& row) {
            if (!from.layer.has(k)) {
                from.layer.put(k, from.time);
                if (kept_of(k) == 0.0f) ripe_.push_back(k);
            }
            float* rest = from.layer.row(k);
            for (std::size_t j = 0; j < kModes; ++j) rest[j] -= row[j];
        });
        for (const std::uint32_t k : ripe_) {
            if (!little(from.layer.row(k))) continue;
            give_rest(m + 1, k, from.place.area[k], from.place.depth[k], from.layer.row(k));
            from.layer.remove(k);
            from.last[k] = kNever;
        }
    }
}

void CoarseHeat::add(CoarseHeat& other, const Row& share, double now) {
    if (other.levels_.empty()) return;
    if (levels_.empty()) make(stepped_ = now);
    for (std::size_t m = 0; m < levels_.size(); ++m) {
        Level &to = *levels_[m], &from = *other.levels_[m];
        from.layer.list(list_);
        for (const std::uint32_t k : list_) {
            to.layer.put(k, to.time);
            to.layer.add(k, from.layer.row(k), share);
        }
    }
}

void CoarseHeat::move(double now, const Way& way) {
    for (const auto& level : levels_) {
        level->layer.list(list_);
        for (const std::uint32_t k : list_)
            level->last[k] = std::max(level->last[k], now - way(level->place.point[k]));
    }
}

float CoarseHeat::kept(const Level& to, double age) {
    const double old = age / to.ripe, since = (to.time - to.before) / to.ripe;
    return static_cast<float>(std::min(left(old) / std::max(left(old - since), 1e-6), 1.0));
}

float CoarseHeat::kept(double age) const {
    return levels_.empty() ? 1.0f : kept(*levels_.front(), age);
}

void CoarseHeat::give(std::uint32_t node, const Row& row, double last) {
    const ThermalNodes& nodes = part_.nodes();
    give(0, node, nodes.area[node], 1.0f / nodes.own[node].modes[0], row, last);
}

// As much heat as it was: by area, and that of the first mode by the sections' depth as well.
void CoarseHeat::give(std::size_t level, std::uint32_t finer, float area, float depth,
                      const Row& row, double last) {
    Level& to = *levels_[level];
    const ThermalLevel::Shares& shares = to.place.shares[finer];
    for (std::size_t i = 0; i < 3; ++i) {
        if (shares.share[i] == 0.0f) continue;
        const std::uint32_t k = shares.node[i];
        const float part = shares.share[i] * area / to.place.area[k];
        Row& there = to.given[k];
        if (!to.layer.has(k) || there == Row{}) to.from.push_back(k);
        to.layer.put(k, to.time);
        to.last[k] = std::max(to.last[k], last);
        add_part(there.data(), part, depth / to.place.depth[k], row.data());
    }
}

void CoarseHeat::take(std::size_t level, const Visit& visit) {
    Level& to = *levels_[level];
    std::sort(to.from.begin(), to.from.end());
    to.from.erase(std::unique(to.from.begin(), to.from.end()), to.from.end());
    list_.clear();
    for (const std::uint32_t k : to.from) {
        for (std::uint32_t i = to.place.first_part[k]; i < to.place.first_part[k + 1]; ++i) {
            const std::uint32_t x = to.place.part[i];
            if (to.visited[x] != 0) continue;
            to.visited[x] = 1;
            list_.push_back(x);
        }
    }
    for (const std::uint32_t x : list_) {
        to.visited[x] = 0;
        const ThermalLevel::Shares& shares = to.place.shares[x];
        Row row{};
        for (std::size_t i = 0; i < 3; ++i)
            if (shares.share[i] != 0.0f)
                for (std::size_t j = 0; j < kModes; ++j)
                    row[j] += shares.share[i] * to.given[shares.node[i]][j];
        visit(x, row);
    }
    for (const std::uint32_t k : to.from) {
        float* row = to.layer.row(k);
        for (std::size_t j = 0; j < kModes; ++j) row[j] += to.given[k][j];
        to.given[k] = {};
    }
    to.from.clear();
}

void CoarseHeat::give_rest(std::uint32_t node, const float* row) {
    const ThermalNodes& nodes = part_.nodes();
    give_rest(0, node, nodes.area[node], 1.0f / nodes.own[node].modes[0], row);
}

void CoarseHeat::give_rest(std::size_t level, std::uint32_t finer, float area, float depth,
                           const float* row) {
    Level& to = *levels_[level];
    const ThermalLevel::Shares& shares = to.place.shares[finer];
    for (std::size_t i = 0; i < 3; ++i) {
        if (shares.share[i] == 0.0f) continue;
        const std::uint32_t k = shares.node[i];
        const float part = shares.share[i] * area / to.place.area[k];
        to.layer.put(k, to.time);
        add_part(to.layer.row(k), part, depth / to.place.depth[k], row);
    }
}

// The slope is that of the decay until the next step, and of what is conducted, to first order.
void CoarseHeat::read_own(Level& level) {
    for (const std::uint32_t k : level.read) level.own[k] = level.own_slope[k] = 0.0f;
    level.layer.list(level.read);
    const auto& decay = factors_(level.interval).decay;
    for (const std::uint32_t k : level.read) {
        const float* row = level.layer.row(k);
        level.own[k] = sum_of_row(row);
        level.own_slope[k] =
            (sum_of_row(row, decay.data()) - level.own[k]) / static_cast<float>(level.interval);
    }
    const ThermalLevel& place = level.place;
    for (const std::uint32_t k : level.read) {
        float flow = 0.0f;
        for (std::uint32_t e = place.first[k]; e < place.first[k + 1]; ++e)
            flow += place.conductance[e] * (level.own[place.neighbour[e]] - level.own[k]);
        level.own_slope[k] += static_cast<float>(diffusivity_) * flow / place.area[k];
    }
}

CoarseHeat::Rise CoarseHeat::between(const Level& level, std::uint32_t finer) {
    const ThermalLevel::Shares& shares = level.place.shares[finer];
    Rise sum{0.0f, 0.0f};
    for (std::size_t i = 0; i < 3; ++i) {
        sum.rise += shares.share[i] * level.total[shares.node[i]];
        sum.slope += shares.share[i] * level.total_slope[shares.node[i]];
    }
    return sum;
}

void CoarseHeat::read(bool all) {
    for (const auto& level : levels_)
        if (all || level->time == stepped_) read_own(*level);
    for (std::size_t m = levels_.size(); m-- > 0;) {
        Level& level = *levels_[m];
        const auto since = static_cast<float>(stepped_ - level.time);
        for (std::uint32_t k = 0; k < level.total.size(); ++k) {
            level.total[k] = level.own[k] + since * level.own_slope[k];
            level.total_slope[k] = level.own_slope[k];
            if (m + 1 == levels_.size()) continue;
            const Rise above = between(*levels_[m + 1], k);
            level.total[k] += above.rise;
            level.total_slope[k] += above.slope;
        }
    }
}

CoarseHeat::Rise CoarseHeat::rise(std::uint32_t node, double now) const {
    if (levels_.empty()) return {0.0f, 0.0f};
    Rise found = between(*levels_.front(), node);
    found.rise += static_cast<float>(now - stepped_) * found.slope;
    return found;
}

const std::vector<CoarseHeat::Risen>& CoarseHeat::risen(const std::vector<float>& peak) {
    risen_.clear();
    for (const auto& one : levels_) {
        const Level& level = *one;
        if (level.time != stepped_) break;
        for (const std::uint32_t k : level.read) {
            float most = level.total[k];
            for (std::uint32_t e = level.place.first[k]; e < level.place.first[k + 1]; ++e)
                most = std::max(most, level.total[level.place.neighbour[e]]);
            for (std::uint32_t i = level.place.first_member[k]; i < level.place.first_member[k + 1];
                 ++i) {
                const std::uint32_t node = level.place.member[i];
                if (most > peak[node]) risen_.push_back({node, rise(node, stepped_).rise});
            }
        }
    }
    return risen_;
}

void CoarseHeat::settle(double now, HeatLayer& layer) {
    for (const auto& level : levels_) {
        level->layer.conduct(now, now - level->time, factors_);
        level->before = level->time;
        level->time = now;
    }
    for (std::size_t m = levels_.size(); m-- > 0;) {
        Level& from = *levels_[m];
        HeatLayer& to = m > 0 ? levels_[m - 1]->layer : layer;
        for (std::uint32_t x = 0; x < to.size(); ++x) {
            const ThermalLevel::Shares& shares = from.place.shares[x];
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t k = shares.node[i];
                if (shares.share[i] == 0.0f || !from.layer.has(k)) continue;
                to.put(x, now);
                float* row = to.row(x);
                const float* there = from.layer.row(k);
                for (std::size_t j = 0; j < kModes; ++j) row[j] += shares.share[i] * there[j];
            }
        }
        from.layer.list(list_);
        for (const std::uint32_t k : list_) from.layer.remove(k);
    }
    stepped_ = now;
    levels_.clear();
}

std::size_t CoarseHeat::Parts::bytes() const {
    std::size_t sum = 0;
    for (const Part& part : levels)
        sum += sizeof part + part.nodes.size() * sizeof(std::uint32_t) +
               part.rows.size() * sizeof(float) + part.last.size() * sizeof(double);
    return sum;
}

CoarseHeat::Parts CoarseHeat::parts() const {
    Parts all;
    all.stepped = stepped_;
    for (const auto& level : levels_) {
        Part part{level->time, level->before, {}, {}, {}};
        level->layer.list(part.nodes);
        part.rows.reserve(part.nodes.size() * kModes);
        for (const std::uint32_t k : part.nodes) {
            part.rows.insert(part.rows.end(), level->layer.row(k), level->layer.row(k) + kModes);
            part.last.push_back(level->last[k]);
        }
        all.levels.push_back(std::move(part));
    }
    return all;
}

void CoarseHeat::restore(const Parts& parts) {
    stepped_ = parts.stepped;
    levels_.clear();
    if (parts.levels.empty()) return;
    make(stepped_);
    for (std::size_t m = 0; m < levels_.size(); ++m) {
        const Part& part = parts.levels[m];
        Level& level = *levels_[m];
        level.time = part.time;
        level.before = part.before;
        for (std::size_t i = 0; i < part.nodes.size(); ++i) {
            level.layer.put(part.nodes[i], part.time);
            level.last[part.nodes[i]] = part.last[i];
            std::copy_n(&part.rows[i * kModes], kModes, level.layer.row(part.nodes[i]));
        }
    }
    read(true);
}

}  // namespace beltgrinding
