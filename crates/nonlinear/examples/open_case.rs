use jointscope_fixture::Fixture;
use jointscope_nonlinear::*;
use jointscope_recordings::*;
fn main() {
    for folder in std::env::args().skip(1) {
        let t = std::time::Instant::now();
        let fixture =
            Fixture::from_json(&std::fs::read_to_string(format!("{folder}/fixture.json")).unwrap()).unwrap();
        let file = jointscope_uff::read(&std::fs::read(format!("{folder}/hits.uff")).unwrap()).unwrap();
        let hits =
            hits_of(&[Source { name: "h".into(), file }], Some(&fixture), &ReadOptions::default()).unwrap();
        let read = t.elapsed();
        let d = NonlinearDiagnosis::of(&fixture, &hits.hits, &NonlinearOptions::default()).unwrap();
        println!("{folder} {:?} {:?} (read {:?}) {:?}", d.verdict, t.elapsed(), read, d.homogeneity);
        for f in &d.findings {
            println!(
                "  {:?} p={} gain {:.4e} reach {:.3e} alt {:?}",
                f.effect,
                f.probability,
                f.gain,
                f.reach,
                f.alternatives.iter().map(|(e, p)| (e.kind.name(), e.dof, *p)).collect::<Vec<_>>()
            );
            for e in &f.estimates {
                println!("    {} {:.5e} {:?}", e.parameter.name, e.value, e.interval);
            }
        }
        if let Some(m) = &d.models {
            for m in m {
                println!("  nrmse {:.4} chi2 {:.4}", m.nrmse, m.chi2_per_dof);
            }
        }
        println!("  held {:?} band {:?}", d.held_out, d.band);
    }
}
