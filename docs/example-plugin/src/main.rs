//! `tabray` with one more plugin.

mod tangle;

fn main() -> std::process::ExitCode {
    tabray::cli::run()
}

#[test]
fn every_plugin_keeps_its_contract() {
    tabray::tools::contract::assert_kept();
}
