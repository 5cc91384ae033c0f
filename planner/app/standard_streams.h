#pragma once

namespace corridor::app {

/// Opens /dev/null on every standard stream that is closed. Without this, the next file that is
/// opened would get the descriptor number of stdout, and the results would be written into it.
/// Reading or writing a stream that was closed still fails, because /dev/null is opened for the
/// opposite access. @pre no other file is open yet.
void openStandardStreams();

/// Flushes stdout. A full disk behind `>` may show only when the buffer is flushed, and half of a
/// result must not end with exit status 0.
/// @throws InputError if something printed on stdout could not be written.
void requireResultsWritten();

}  // namespace corridor::app
