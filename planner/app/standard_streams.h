#pragma once

namespace corridor::app {

/// Opens /dev/null on every standard stream that is closed. Without this, the next file that is
/// opened would get the number of stdout, and the results would be written into it. Using a stream
/// that was closed still fails. @pre no other file is open yet.
void openStandardStreams();

/// Flushes stdout. A full disk behind `>` may show only when the buffer is flushed, and half of a
/// result must not end with exit status 0.
/// @throws InputError if something printed on stdout could not be written.
void requireResultsWritten();

}  // namespace corridor::app
