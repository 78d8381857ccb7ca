#include "exitance/discontinuity/node_values.hpp"

#include <algorithm>
#include <atomic>

#include "exitance/base/parallel.hpp"

namespace exitance {

bool NodeValues::look_at(std::vector<std::uint32_t> nodes, const Look& look, const StopRequest& stop,
                         const std::function<void()>& keep) {
    constexpr std::size_t batch_size = 4'096;  // nodes per batch, between two checkpoints
    std::erase_if(nodes, [&](std::uint32_t n) { return has(n); });
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.empty()) return true;
    if (nodes.back() >= values_.size()) values_.resize(nodes.back() + 1), has_.resize(nodes.back() + 1, 0);
    for (std::size_t start = 0; start < nodes.size();) {
        const std::size_t known = order_.size() < found_.size() ? found_.size() - order_.size() : 0;
        const std::size_t count = std::min(known > 0 ? known : batch_size, nodes.size() - start);
        const std::span<const std::uint32_t> batch = std::span(nodes).subspan(start, count);
        if (known > 0) {
            for (std::size_t i = 0; i < count; ++i) values_[batch[i]] = found_[order_.size() + i];
        } else {
            std::atomic<std::size_t> left = count;
            parallel_ranges(count, 32, [&](std::size_t first, std::size_t last) {
                WeakLight::Workspace workspace;
                for (std::size_t i = first; i < last && !stop.requested(); ++i)
                    values_[batch[i]] = look(batch[i], workspace), --left;
            });
            if (left > 0) return false;
        }
        for (const std::uint32_t n : batch) has_[n] = 1;
        order_.insert(order_.end(), batch.begin(), batch.end());
        start += count;
        if (known == 0) keep();
    }
    return true;
}

std::vector<Spectrum> NodeValues::in_order() const {
    if (order_.size() <= found_.size()) return found_;
    std::vector<Spectrum> out;
    out.reserve(order_.size());
    for (const std::uint32_t n : order_) out.push_back(values_[n]);
    return out;
}

}  // namespace exitance
