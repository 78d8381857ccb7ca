#include <exitance/base/memory.hpp>
#include <exitance/base/parallel.hpp>
#include <exitance/base/spectrum.hpp>

int main() {
    const double sum = exitance::parallel_sum<double>(1000, [](std::size_t i) { return static_cast<double>(i); });
    const bool right = sum == 499500 && exitance::peak_memory_bytes() > 0 && exitance::mean(exitance::Spectrum(2)) == 2;
    return right ? 0 : 1;
}
