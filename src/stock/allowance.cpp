#include <cmath>

#include "beltgrinding/error.h"
#include "beltgrinding/stock.h"
#include "heightfield/edge_rays.h"

namespace beltgrinding {
namespace {

/// Height of a layer of uniform thickness along the ray of a sample at `distance` mm from a sharp
/// edge, all in mm: beside the edge that of the plane, round the edge that of the circle about it.
double layer_on(double thickness, double tangent, double distance) {
    if (!(thickness > 0.0) || thickness * tangent <= distance) return thickness;
    const double square = 1.0 + tangent * tangent;
    return (tangent * distance + std::sqrt(thickness * thickness * square - distance * distance)) /
           square;
}

}  // namespace

StockReport apply_allowance(HeightField& field, double allowance) {
    field.validate();
    if (!std::isfinite(allowance)) {
        throw InputError("stock.allowance",
                         "stock: the allowance must be a finite number of millimetres");
    }
    StockReport report;
    const std::vector<float> distances = edge_distances(field);
    for (std::size_t i = 0; i < field.size(); ++i) {
        double height = allowance;
        if (!distances.empty() && std::isfinite(distances[i])) {
            const double longer = field.rays[i].norm();
            height =
                layer_on(allowance, std::sqrt(std::max(longer * longer - 1.0, 0.0)), distances[i]);
        }
        field.height[i] = height;
        field.stock_height[i] = static_cast<float>(height);
        field.flags[i] = static_cast<std::uint8_t>(field.flags[i] & ~(kMissed | kDefective));
        if (allowance < 0.0) {
            field.flags[i] |= kDefective;
            ++report.defective;
        }
        report.volume += field.area[i] * std::max(height, 0.0);
    }
    if (allowance < 0.0) {
        report.warnings.push_back(
            {"stock.negative_allowance",
             "the stock allowance is negative: the stock lies below the design",
             {}});
    }
    return report;
}

}  // namespace beltgrinding
