#pragma once

#include "exitance/cli/options/arguments.hpp"
#include "exitance/cli/terminal.hpp"
#include "exitance/cli/view/view_changes.hpp"
#include "exitance/cli/view/view_events.hpp"

namespace exitance {

/// A solve that shows its light as it converges.
class ViewSolve {
  public:
    /// `gallery` gets every solution, and `changes` the light groups at the end. All arguments except the scene must
    /// outlive the object.
    ViewSolve(const ViewArguments& arguments, Scene scene, Gallery& gallery, ViewChanges& changes, Terminal& terminal);

    /// Registers the requests for the events of the solve, to stop it, and to save the newest solution.
    void serve(ViewServer& server);
    /// Solves. Sends events to the pages whenever there is new light, and at the end.
    void run();

  private:
    std::string describe_end(const SolveStatistics& statistics) const;
    ViewAnswer save();

    const ViewArguments& arguments_;
    Scene scene_;
    Gallery& gallery_;
    ViewChanges& changes_;  ///< Gets the light groups at the end of the solve.
    ViewEvents events_;
    ViewProgress progress_;
    RunLimits& limits_;
};

}  // namespace exitance
