#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "exitance/experiments/flatland/kernel_terms.hpp"

// exitance-flatland [LEVELS]: errors of kernels 1 / ((x - y)^2 + h^2), smooth and with a step at x = y, when the m
// largest of their terms are kept, as CSV. LEVELS (8): 2^LEVELS functions a direction.
int main(int argc, char** argv) {
    using namespace exitance::flatland;
    const int levels = argc > 1 ? std::atoi(argv[1]) : 8;
    if (levels < 2 || levels > 10) return std::fprintf(stderr, "error: LEVELS must be from 2 to 10\n"), 2;
    std::vector<std::size_t> counts;
    for (std::size_t m = 1; m <= std::size_t(1) << (2 * levels); m *= 2) counts.push_back(m);
    std::puts("kernel,h,basis,decomposition,terms,m,relative_l2_error");
    for (const bool step : {false, true})
        for (const double h : {1.0, 0.2, 0.1, 0.05, 0.02})
            for (const LineBasis basis : line_bases)
                for (const Decomposition way : {Decomposition::standard, Decomposition::non_standard}) {
                    const KernelTerms terms(basis, way, levels, [&](double x, double y) {
                        return step && x <= y ? 0.0 : 1 / ((x - y) * (x - y) + h * h);
                    });
                    const std::vector<double> errors = terms.errors(counts);
                    for (std::size_t i = 0; i < counts.size(); ++i)
                        std::printf("%s,%g,%s,%s,%zu,%zu,%.6g\n", step ? "step" : "smooth", h,
                                    std::string(name_of(basis)).c_str(),
                                    way == Decomposition::standard ? "standard" : "non-standard", terms.size(),
                                    counts[i], errors[i]);
                }
}
