# Recipes for https://just.systems; each is also a plain command that can be typed.

# List the recipes.
default:
    @just --list

# Run a scenario: just run scenarios/push_stick.toml --trials 10
run *ARGS="scenarios/push_stick.toml":
    cargo run --release -- run {{ARGS}}

# Run all tests.
test *ARGS:
    cargo test --release --workspace {{ARGS}}

# Check format and lints.
lint:
    cargo fmt --all --check
    cargo clippy --release --workspace --all-targets -- -D warnings

# Build the documentation; open it with: just doc --open
doc *ARGS:
    RUSTDOCFLAGS="-D warnings" cargo doc --release --workspace --no-deps {{ARGS}}

# Run the benches.
bench *ARGS:
    cargo bench --workspace {{ARGS}}

# Run everything that must pass before a commit is shared.
ci:
    .ci/run
