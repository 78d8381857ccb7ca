#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exitance/base/checkpoint.hpp"
#include "exitance/base/result.hpp"
#include "exitance/io/solution/checkpoint_parts.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Names and values that identify the work of a checkpoint: a run resumes from it only if all of them are equal.
using CheckpointFacts = std::vector<std::pair<std::string, std::string>>;

/// Returns a hash, as text, of everything that determines the light of a scene, and of the order of its faces.
std::string scene_fingerprint(const Scene& scene);

/// The state of a solve in a file, with a checksum; written whole or not at all. With several processes, each writes
/// its part, the first one in this file (see `checkpoint_parts.hpp`); any number of processes can read it. Only the
/// same program on the same kind of machine can read it. All functions are collective.
class CheckpointFile final : public CheckpointStore {
  public:
    /// Adds the program's version and build to `facts`. `every` is the time between checkpoints, in seconds, measured
    /// by the first process; infinity: no checkpoints.
    CheckpointFile(std::string path, CheckpointFacts facts, double every);

    /// Reads the checkpoint from which the solve resumes. Returns false if there is none. Error (bad_input): a fact
    /// differs, or a file is damaged or missing; the message says which.
    Result<bool> load();
    bool is_due() const override;
    void keep(std::string dealt) override;
    std::string resumed() override { return std::exchange(state_, {}); }
    /// Result of the last keep(). If it failed, the previous checkpoint is unchanged.
    const Result<void>& written() const { return written_; }
    void remove() const;

  private:
    Result<bool> read();
    Result<void> write(std::vector<CheckpointPart> parts, std::string dealt) const;

    std::string path_;
    CheckpointFacts facts_;
    double every_;
    Stopwatch watch_;
    std::uint64_t generation_ = 0;  ///< Generation that was read or written last.
    std::string state_;
    Result<void> written_;
};

}  // namespace exitance
