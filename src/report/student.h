// Enters: a t statistic, degrees of freedom.
// Leaves: the tail of Student's distribution.
#pragma once

namespace ajar {

/// P(T > t) of Student's t distribution for t >= 0 and any dof > 0, accurate in relative terms far into the tail.
double student_tail(double t, double dof);

}  // namespace ajar
