// Checks rows of a file of view factors with independent rays:
//
//     exitance-check-view-factors SCENE F.h5 ERROR [ROWS=20 [RAYS=10000000 [SEED=1 [THREADS=1]]]]
//
// Draws rows at random and casts RAYS rays from each face in two halves, G1 and G2. Prints for every row the squared
// error sum_j (F - G1)_j (F - G2)_j with its standard error, and the largest excess of |sum_j (F - G)_j x_j| over ERROR
// in standard errors, for x = 1 and 16 random groups of neighbouring faces. Exit status 1 if an excess is above 3.5
// standard errors.
#include <cstdio>
#include <cstdlib>

#include "exitance/base/check.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"
#include "exitance/view_factors/row_check.hpp"

int main(int count, char** words) {
    using namespace exitance;
    if (count < 4) {
        std::fprintf(stderr, "usage: %s SCENE F.h5 ERROR [ROWS [RAYS [SEED [THREADS]]]]\n", words[0]);
        return 2;
    }
    const auto number = [&](int k, double otherwise) { return count > k ? std::atof(words[k]) : otherwise; };
    const CheckedScene checked = load_scene({words[1]}, {});
    const Result<SparseFactors> table = read_view_factors(words[2]);
    if (!checked.scene || !table) {
        std::fprintf(stderr, "%s\n", table ? "the scene cannot be read" : table.error().message.c_str());
        return 2;
    }
    const double error = number(3, 1e-3);
    set_threads(static_cast<int>(number(7, 1)));
    const RowCheck check = check_rows_by_rays(*checked.scene, *table,
                                              {.rows = static_cast<std::size_t>(number(4, 20)),
                                               .rays = static_cast<std::size_t>(number(5, 1e7) / 2),
                                               .seed = static_cast<std::uint64_t>(number(6, 1)),
                                               .error = error},
                                              StopRequest());
    for (const CheckedRow& row : check.rows)
        std::printf("row %zu: squared error %.3g +- %.2g, %.2f standard errors above R^2; sums %.2f above R\n",
                    row.face + 1, row.squared_error, row.squared_error_deviation, row.squared_excess(error),
                    row.largest_sum_excess);
    std::printf("%zu rows, %zu rays: error %.3g, %zu rows wrong\n", check.rows.size(), check.rays, check.error,
                check.wrong);
    return check.wrong == 0 ? 0 : 1;
}
