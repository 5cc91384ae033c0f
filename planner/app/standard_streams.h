#pragma once

namespace corridor::app {

/// Gives closed standard streams a file, before any other file is opened: else that would get the
/// number of stdout, and the results with it. Using such a stream is still an error.
void openStandardStreams();

/// A full disk behind `>` shows only when all has been printed, and half of a result is none.
/// @throws InputError if what was printed on stdout could not be written.
void requireResultsWritten();

}  // namespace corridor::app
