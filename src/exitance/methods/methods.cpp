#include "exitance/methods/methods.hpp"

namespace exitance {

std::span<const MethodEntry> method_table() {
    static constexpr MethodEntry table[] = {
        {Method::matrix, solve_matrix, "constant"},
        {Method::progressive, solve_progressive, "constant"},
        {Method::substructuring, solve_substructuring, "constant"},
        {Method::monte_carlo, solve_monte_carlo, "constant"},
    };
    return table;
}

}  // namespace exitance
