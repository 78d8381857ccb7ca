#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exitance/base/checkpoint.hpp"
#include "exitance/base/result.hpp"
#include "exitance/io/solution/checkpoint_parts.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// What a checkpoint is of, by name: a run goes on from it only where all of this is the same.
using CheckpointFacts = std::vector<std::pair<std::string, std::string>>;

/// A hash of all that the light of a scene depends on, and of the numbers of its faces, as text.
std::string scene_fingerprint(const Scene& scene);

/// The state of a solve in a file beside its result, with a checksum; replaced whole or not at all. Of several
/// processes each writes its part, the first one in that file (`checkpoint_parts.hpp`); any number of them reads it.
/// Read by the program that wrote it and on the same kind of machine only. All.
class CheckpointFile final : public CheckpointStore {
  public:
    /// The program's version and build are added to the facts. `every`: seconds from one checkpoint to the next, as the
    /// first process sees them; infinite: write none.
    CheckpointFile(std::string path, CheckpointFacts facts, double every);

    /// Reads the file, so that the solve goes on from there. False where there is none. An error (bad_input) names what
    /// the file is of and this run is not, or says which file is damaged or missing.
    Result<bool> load();
    bool is_due() const override;
    void keep(std::string dealt) override;
    std::string resumed() override { return std::exchange(state_, {}); }
    /// How the last writing went. Where it failed, what was kept before stands.
    const Result<void>& written() const { return written_; }
    void remove() const;

  private:
    Result<bool> read();
    Result<void> write(std::vector<CheckpointPart> parts, std::string dealt) const;

    std::string path_;
    CheckpointFacts facts_;
    double every_;
    Stopwatch watch_;
    std::uint64_t generation_ = 0;  ///< Of what was read or written last.
    std::string state_;
    Result<void> written_;
};

}  // namespace exitance
