#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"
#include "beltgrinding/stock.h"

namespace beltgrinding {

StockReport add_stock(HeightField& field, const std::vector<double>& thickness) {
    field.validate();
    if (thickness.size() != field.size()) {
        throw InputError("stock.added_count", "stock: {given} thicknesses for {count} samples",
                         {{"given", thickness.size()}, {"count", field.size()}});
    }
    if (!std::all_of(thickness.begin(), thickness.end(),
                     [](double value) { return std::isfinite(value); })) {
        throw InputError("stock.added_finite", "stock: a thickness to be added is not finite");
    }
    StockReport report;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if ((field.flags[i] & kMissed) != 0) {
            ++report.missed;
            continue;
        }
        const double height = field.height[i] + thickness[i];
        field.height[i] = height;
        field.stock_height[i] = static_cast<float>(height);
        field.flags[i] = static_cast<std::uint8_t>(field.flags[i] & ~kDefective);
        if (height < 0.0) {
            field.flags[i] |= kDefective;
            ++report.defective;
        }
        report.volume += field.area[i] * std::max(height, 0.0);
    }
    if (report.defective > 0) {
        report.warnings.push_back({"stock.below_design",
                                   "the stock lies below the design at {count} samples",
                                   {{"count", report.defective}}});
    }
    return report;
}

}  // namespace beltgrinding
