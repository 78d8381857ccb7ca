#pragma once

#include <functional>
#include <string>

#include "exitance/base/archive.hpp"
#include "exitance/base/progress.hpp"

namespace exitance {

/// Stores the state of a long run from time to time, so that a later run can continue from it. If several processes
/// solve together, all of them must make the same calls in the same order.
class CheckpointStore {
  public:
    virtual ~CheckpointStore() = default;

    /// True if it is time to save the state again.
    virtual bool is_due() const = 0;
    /// Saves a state and replaces the previous one. Each of several processes passes its own part (`DealtBytes`).
    virtual void keep(std::string dealt) = 0;
    /// Returns the whole state to continue from; empty if the run starts from scratch.
    virtual std::string resumed() = 0;
};

/// Lets a long phase save its own state between its rounds. The caller of the phase adds the state of everything around
/// it. Without a store, nothing is ever saved.
class SafePoints {
  public:
    SafePoints() = default;
    /// `keep` is called with the state of the phase to store it. `resumed`: the state of the phase to continue from;
    /// empty to start from scratch.
    SafePoints(const CheckpointStore* store, const StopRequest& stop, std::function<void(std::string)> keep,
               std::string resumed)
        : store_(store), stop_(&stop), keep_(std::move(keep)), resumed_(std::move(resumed)) {}

    /// To be called between rounds. If saving is due, saves the bytes that `write(archive)` writes. Saves nothing after
    /// a stop was requested, since the results of an interrupted round may be incomplete.
    template <class Write>
    void pass(const Write& write) const {
        if (!store_ || stop_->requested() || !store_->is_due()) return;
        ArchiveWriter writer;
        write(writer);
        keep_(writer.take());
    }

    /// Restores the state of an earlier run by read(archive), if there is one. Returns true if it did.
    template <class Read>
    bool resume(const Read& read) {
        if (resumed_.empty()) return false;
        ArchiveReader reader(resumed_);
        read(reader);
        resumed_.clear();
        return true;
    }

  private:
    const CheckpointStore* store_ = nullptr;
    const StopRequest* stop_ = nullptr;
    std::function<void(std::string)> keep_;
    std::string resumed_;
};

}  // namespace exitance
