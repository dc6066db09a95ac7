#pragma once

namespace touchstone {

/// Returns in a copy of this process for each question that comes, with the question's streams as standard
/// input and output; the process itself waits for questions on its standard input, a socket of
/// engine/process/prepared_program.h, and ends where that ends. The copies are children of the parent, which
/// waits for them; they have the limits of this process, and at most `processorSeconds` each. To be called
/// with one thread and no lock held: what pthread_atfork registers is not called.
void becomeCopies(unsigned processorSeconds);

} // namespace touchstone
