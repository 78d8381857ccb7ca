#pragma once

namespace exitance {

/// How a tolerance is lowered from round to round, until the errors that add up under it are no larger than allowed.
///
/// A lower tolerance makes more links, so that their errors together fall more slowly than it: like a power of it,
/// which depends on the scene. A guess to begin with; later what the last two rounds have shown.
class ToleranceLaw {
  public:
    /// `exponent`: the tolerance is to fall like the error to this power, or faster.
    explicit ToleranceLaw(double exponent) : exponent_(exponent) {}

    /// What to multiply the tolerance by that `error` came of; 1 where it is no larger than allowed. Nothing is learnt
    /// from the first round, whose light lacks reflections.
    double factor(double error, double allowed);

    template <class Archive>
    void archive_state(Archive& a) {
        a(round_, last_error_, last_factor_);
    }

  private:
    double exponent_;
    int round_ = 0;
    double last_error_ = 0, last_factor_ = 1;
};

}  // namespace exitance
