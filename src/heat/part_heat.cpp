#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "beltgrinding/heat.h"
#include "heat/heat_spectrum.h"
#include "heat/thermal_levels.h"
#include "heat/thermal_nodes.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 4096;     // of samples, for a thread
constexpr double kSamplesPerNode = 1.5;  // of the field's spacing, at least

// As in job.schema.json and job/load.py.
void check(double value, const char* name, double least, double most) {
    if (!(value >= least && value <= most)) {
        throw InputError("heat.material",
                         "the material's {name} is {value:.4g}; materials have {least} to {most}",
                         {{"name", name}, {"value", value}, {"least", least}, {"most", most}});
    }
}

/// K/mm, by node: least squares over the neighbours, in the tangent plane.
std::vector<Vec3f> gradients(const ThermalNodes& nodes, const std::vector<float>& values) {
    std::vector<Vec3f> found(nodes.size(), Vec3f::Zero());
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        bool flat = true;
        for (std::uint32_t e = nodes.first[k]; e < nodes.first[k + 1]; ++e)
            flat = flat && values[nodes.neighbour[e]] == values[k];
        if (flat) continue;
        const Vec3 n = nodes.normal[k].cast<double>();
        // Along the normal nothing is known: 0.
        Eigen::Matrix3d square = n * n.transpose();
        Vec3 right = Vec3::Zero();
        int count = 0;
        for (std::uint32_t e = nodes.first[k]; e < nodes.first[k + 1]; ++e) {
            const std::uint32_t other = nodes.neighbour[e];
            Vec3 way = nodes.point[other] - nodes.point[k];
            way = (way - n.dot(way) * n).eval();
            const double weight = 1.0 / way.squaredNorm();
            if (!std::isfinite(weight)) continue;
            square += weight * way * way.transpose();
            right += weight * (values[other] - values[k]) * way;
            ++count;
        }
        if (count < 3 || !(square.determinant() > 1e-3)) continue;
        found[k] = (square.inverse() * right).cast<float>();
    }
    return found;
}

/// At a point, of which `node` is the nearest: modified Shepard weights, each node with its plane
/// (Franke & Nielson 1980), never beyond what the nodes have.
float between(const ThermalNodes& nodes, const std::vector<float>& values,
              const std::vector<Vec3f>& slope, std::uint32_t node, const Vec3& point) {
    const double reach = 2.0 * nodes.spacing;
    float least = values[node], most = least;
    double sum = 0.0, weights = 0.0;
    const auto add = [&](std::uint32_t k) {
        const Vec3 way = point - nodes.point[k];
        const double away = std::max(way.norm(), 1e-6 * reach);
        const double share = std::max(reach - away, 0.0) / (reach * away);
        const double weight = share * share;
        sum += weight * (values[k] + slope[k].cast<double>().dot(way));
        weights += weight;
        least = std::min(least, values[k]);
        most = std::max(most, values[k]);
    };
    add(node);
    for (std::uint32_t e = nodes.first[node]; e < nodes.first[node + 1]; ++e)
        add(nodes.neighbour[e]);
    const auto value = weights > 0.0 ? static_cast<float>(sum / weights) : values[node];
    return std::clamp(value, least, most);
}

}  // namespace

struct PartHeat::Levels {
    std::once_flag once, spectral;
    std::vector<ThermalLevel> all;
    std::unique_ptr<const HeatSpectrum> spectrum;
};

void HeatMaterial::validate() const {
    check(conductivity, "conductivity (W/(m K))", 0.1, 2500.0);
    check(heat_capacity, "heat capacity (J/(kg K))", 0.1, 15000.0);
    check(density, "density (kg/m3)", 1.0, 25000.0);
    check(1e-3 * heat_capacity * density, "heat capacity times density (kJ/(m3 K))", 1.0, 1e4);
}

PartHeat::PartHeat(const HeightField& field, double spacing, const HeatMaterial& material)
    : material_(material) {
    field.validate();
    material.validate();
    if (field.size() == 0) throw InputError("heat.empty_field", "the height field is empty");
    if (!std::isfinite(spacing) || spacing <= 0.0) {
        throw InputError("heat.spacing", "the distance of the heat's nodes must be positive");
    }
    const double apart = std::max(spacing, kSamplesPerNode * field.spacing);
    nodes_ = std::make_shared<ThermalNodes>(
        make_thermal_nodes(field, apart, DepthModes::longer(material.diffusivity(), apart)));
    levels_ = std::make_shared<Levels>();
    const std::size_t n = nodes_->size();
    state_.modes.assign(n * DepthModes::kModes, 0.0f);
    state_.last.assign(n, -1e30);
    state_.warm.assign(n, 0);
    state_.peak.assign(n, 0.0f);
    state_.source.assign(n, HeatState::kNever);
}

double PartHeat::spacing() const {
    return nodes_->spacing;
}

std::size_t PartHeat::size() const {
    return nodes_->size();
}

const std::vector<std::uint32_t>& PartHeat::samples() const {
    return nodes_->sample;
}

const std::vector<std::uint32_t>& PartHeat::node_of() const {
    return nodes_->node_of;
}

void PartHeat::set_thickness(const std::vector<float>& thickness) {
    // Copies of the part share its nodes.
    if (nodes_.use_count() > 1) nodes_ = std::make_shared<ThermalNodes>(*nodes_);
    beltgrinding::set_thickness(*nodes_, thickness);
    levels_ = std::make_shared<Levels>();
}

const std::vector<ThermalLevel>& PartHeat::levels() const {
    std::call_once(levels_->once, [this] { levels_->all = make_thermal_levels(*nodes_); });
    return levels_->all;
}

const HeatSpectrum& PartHeat::spectrum() const {
    const auto& all = levels();
    std::call_once(levels_->spectral, [&] {
        const ThermalNodes& nodes = *nodes_;
        if (!all.empty()) {
            const ThermalLevel& last = all.back();
            levels_->spectrum = std::make_unique<HeatSpectrum>(
                HeatLayer::Grid{last.first, last.neighbour, last.conductance, last.area, last.depth,
                                last.sectional, last.spacing, last.dispersion, nullptr});
            return;
        }
        const std::vector<float> depth = nodes.depth(),
                                 sectional = sectional_conductances(nodes, depth);
        levels_->spectrum = std::make_unique<HeatSpectrum>(
            HeatLayer::Grid{nodes.first, nodes.neighbour, nodes.conductance, nodes.area, depth,
                            sectional, nodes.spacing, nodes.dispersion, nullptr});
    });
    return *levels_->spectrum;
}

const std::vector<float>& PartHeat::thickness() const {
    return nodes_->thickness;
}

void PartHeat::set_state(HeatState state) {
    const std::size_t n = nodes_->size();
    if (state.modes.size() != n * DepthModes::kModes || state.last.size() != n ||
        state.warm.size() != n || state.peak.size() != n || state.source.size() != n) {
        throw InputError("heat.other_state", "the heat's state is of another part");
    }
    state_ = std::move(state);
}

std::size_t PartHeat::bytes() const {
    return nodes_->bytes() +
           nodes_->size() * (DepthModes::kModes * sizeof(float) + sizeof(double) +
                             sizeof(std::uint8_t) + sizeof(float) + sizeof(std::uint32_t));
}

void PartHeat::keep(HeightField& field) const {
    field.validate();
    const ThermalNodes& nodes = *nodes_;
    if (field.size() != nodes.node_of.size()) {
        throw InputError("heat.other_field", "the heat is of another height field");
    }
    const std::vector<Vec3f> slope = gradients(nodes, state_.peak);
    field.heat.rise.assign(field.size(), 0.0f);
    field.heat.motion.assign(field.size(), HeatState::kNever);
    parallel_blocks(field.size(), kBlock, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const std::uint32_t node = nodes.node_of[s];
            if (state_.source[node] == HeatState::kNever) continue;
            field.heat.motion[s] = state_.source[node];
            field.heat.rise[s] = between(nodes, state_.peak, slope, node, field.point[s]);
        }
    });
}

}  // namespace beltgrinding
