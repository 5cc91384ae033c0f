#pragma once

#include <vector>

#include "planner/trajectory/trajectory_file.h"
#include "planner/trajectory/trajectory_table.h"

namespace corridor {

/// The meaning of each column of a table, for each quantity.
struct TableColumns {
  std::vector<JointNames::Meaning> positions, velocities, accelerations;
};

/// Checks the columns of joints that are not planned for. No coordinate describes these joints, so
/// a proof covers what the file says about them only if it says what the model says:
/// - A held joint stays at its held value, and a mimic joint on its rule, up to
///   `equalUpToRounding`. This must hold for the whole curve between the rows, with its velocities
///   and accelerations. Otherwise adds a fault for the joint's first such row.
/// - A fixed joint does not move. A constant position that is not 0 is a note.
/// - Planar and floating joints that are held have no columns.
///
/// Between two rows, the Bernstein coefficients of the curve of degree 1, 3 or 5 are
/// p, p ± T·v/3 (degree 3), p ± T·v/5 and p ± 2·T·v/5 + T²·a/20 (degree 5), where p, v and a belong
/// to one of the two rows and T is the time between them. So the curve is within the largest value
/// of |p| + T·|v| + T²·|a| of 0 if p is the difference from the required position, and v and a are
/// its derivatives.
/// @param rows the rows made of the table, one for each row of the table.
void checkUnplanned(const TrajectoryTable& table, const TableColumns& columns, const Model& model,
                    const TrajectoryRows& rows, FaultList& faults, std::vector<Note>& notes);

/// Checks the state from which a message says that the robot starts (`TrajectoryTable::start`):
/// held joints must be at their held values, mimic joints on their rule, and planned joints at the
/// values of the first row. Differences are faults, except differences of planned joints of at most
/// `limitSlack` rad or m: these are a note, since a controller moves to the first row. Values of
/// unknown joints are a note, too. Its poses must be those of the model (`conflictOf`).
void checkStart(const TrajectoryTable& table, const JointNames& names, const Model& model,
                const TrajectoryRows& rows, FaultList& faults, std::vector<Note>& notes);

}  // namespace corridor
