// A shared library for tests, as one of another release would be.
extern "C" {
const char* tassilo_built_for() { return "tassilo 0.0.1 by gcc 4"; }
void tassilo_register(void*) {}
}
