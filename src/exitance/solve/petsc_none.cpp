#include "exitance/processes/value_scatter.hpp"
#include "exitance/solve/gmres.hpp"

// Implementation for builds without PETSc: values that a process reads from others are sent to all processes.

namespace exitance {
namespace {

class SentToAll final : public ValueScatter {
  public:
    SentToAll(const DealtUnknowns& dealt, std::span<const std::uint32_t> read)
        : dealt_(dealt), read_(read.begin(), read.end()) {}

    void fetch(std::span<const Spectrum> own, std::span<Spectrum> fetched) const override {
        std::vector<Spectrum> all(dealt_.count());
        dealt_.tell(own, std::span(all), "solve");
        for (std::size_t k = 0; k < read_.size(); ++k) fetched[k] = all[read_[k]];
    }

  private:
    DealtUnknowns dealt_;
    std::vector<std::uint32_t> read_;
};

}  // namespace

std::shared_ptr<const ValueScatter> make_scatter(const DealtUnknowns& dealt, std::span<const std::uint32_t> read) {
    return std::make_shared<SentToAll>(dealt, read);
}

SolveReport gmres_over_processes(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop) {
    return gmres(system, b, stop);
}

}  // namespace exitance
