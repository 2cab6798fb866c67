//! Trial.
use meshtone::scenario::*;
fn main() {
    if let Ok(v)=std::env::var("RATE") { println!("{v}"); }
    for rig in [None, Some(GearboxRig::Phm2009Spur), Some(GearboxRig::Uconn), Some(GearboxRig::Tecnalia)] {
        let text = gearbox_template(rig);
        let mut g = match Gearbox::from_toml(&text) { Ok(g) => g, Err(e) => { println!("{rig:?}: {e} {:?}", e.help); continue } };
        assert_eq!(Gearbox::from_toml(&g.to_toml()).unwrap(), g);
        if std::env::var("ONE").is_ok() && rig.is_some() { break }
        if let Ok(v)=std::env::var("RATE") { g.solver.settings.sampling_rate_hz=v.parse().unwrap(); }
        if rig.is_none() { g.sensors.clear(); g.material = Material::Given(MaterialConstants{youngs_modulus_gpa:206.0,poisson_ratio:0.3,density_kg_per_m3:7850.0}); for w in &mut g.wheels { w.tip_chamfer_mm=Some(0.0); if std::env::var("IDEAL").is_ok() { w.iso_class=0; let mut x=7u64+w.teeth as u64; let mut acc=0.0; let n=w.teeth; let raw: Vec<f64>=(0..n).map(|_| { x=x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); acc+=((x>>33) as f64/2f64.powi(31)-0.5)*2.0; acc}).collect(); let end=raw[n as usize-1]; w.deviations.cumulative_pitch_um=Some(raw.iter().enumerate().map(|(i,v)| (v-end*(i as f64+1.0)/n as f64)*2.0/3.0).collect()); w.deviations.run_out_um=Some(6.0);} } }
        let s = meshtone::simulate_gearbox(&g).unwrap();
        println!("{rig:?} rate {} kept {} first sim {} first kept {}", s.channels.sampling_rate_hz, s.channels.len(), s.stages.time.first_simulated_sample, s.stages.time.first_kept_sample);
        println!("  freqs {:.2?}", &s.stages.natural_frequencies_hz()[..9]);
        println!("  cycle {} ratios {:?} static {:?} kbar {:?}", s.stages.layout.cycle_revolutions(), s.stages.layout.ratios, s.stages.pairs.iter().map(|p| p.static_force_n).collect::<Vec<_>>(), s.stages.mean_stiffness_n_per_m());
        for m in &s.stages.meshes { let k = m.healthy_stiffness_n_per_mm(); println!("   k {:.2} {:.2}", k.iter().cloned().fold(f64::INFINITY,f64::min), k.iter().cloned().fold(0.0,f64::max)); }
        for c in &s.channels.signals { let n=c.values.len() as f64; let m=c.values.iter().sum::<f64>()/n; let sd=(c.values.iter().map(|v| (v-m).powi(2)).sum::<f64>()/n).sqrt(); let lo=c.values.iter().cloned().fold(f64::INFINITY,f64::min); let hi=c.values.iter().cloned().fold(-f64::INFINITY,f64::max); println!("  {:40} mean {m:.5} sd {sd:.5} ({:.3}) min {lo:.4} max {hi:.4}", c.name, sd*9.81); }
        for t in &s.timings { println!("   {:30} {:.1?}", t.stage, t.elapsed); }
    }
}
