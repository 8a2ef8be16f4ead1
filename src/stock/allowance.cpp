#include <cmath>

#include "beltgrinding/error.h"
#include "beltgrinding/stock.h"

namespace beltgrinding {

StockReport apply_allowance(HeightField& field, double allowance) {
    if (!std::isfinite(allowance)) {
        throw InputError("stock.allowance",
                         "stock: the allowance must be a finite number of millimetres");
    }
    StockReport report;
    for (std::size_t i = 0; i < field.size(); ++i) {
        field.height[i] = allowance;
        field.stock_height[i] = static_cast<float>(allowance);
        field.flags[i] = static_cast<std::uint8_t>(field.flags[i] & ~(kMissed | kDefective));
        if (allowance < 0.0) {
            field.flags[i] |= kDefective;
            ++report.defective;
        }
        report.volume += field.area[i] * std::max(allowance, 0.0);
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
