#pragma once

#include <functional>
#include <string>

#include "exitance/base/archive.hpp"
#include "exitance/base/progress.hpp"

namespace exitance {

/// Where a long run keeps its state from time to time, so that another run can go on from there. Where several
/// processes make the run, all of them call it at the same places.
class CheckpointStore {
  public:
    virtual ~CheckpointStore() = default;

    /// Is it time to keep the state again?
    virtual bool is_due() const = 0;
    /// Keeps a state in place of the one before; of several processes, each gives what of it is dealt to it.
    virtual void keep(std::string dealt) = 0;
    /// Hands over the whole state to go on from; empty: begin at the beginning.
    virtual std::string resumed() = 0;
};

/// What a long phase is given, so that its own state can be kept between its rounds. The state of everything around the
/// phase is added by whoever runs it. Without a store, nothing is ever due.
class SafePoints {
  public:
    SafePoints() = default;
    /// `keep` is given the phase's state; `resumed`: the one to go on from, or empty.
    SafePoints(const CheckpointStore* store, const StopRequest& stop, std::function<void(std::string)> keep,
               std::string resumed)
        : store_(store), stop_(&stop), keep_(std::move(keep)), resumed_(std::move(resumed)) {}

    /// Called between rounds: keeps what `write(archive)` writes, if that is due. Not once a stop is asked for, since
    /// what has been computed then may be half done.
    template <class Write>
    void pass(const Write& write) const {
        if (!store_ || stop_->requested() || !store_->is_due()) return;
        ArchiveWriter writer;
        write(writer);
        keep_(writer.take());
    }

    /// Goes on from the state of an earlier run, if there is one: read(archive) reads it. Returns whether it did.
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
