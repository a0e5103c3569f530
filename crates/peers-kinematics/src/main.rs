use std::hint::black_box;
use std::time::Instant;
use seamline::geometry::*;
use seamline::kinematics::*;

struct R(u64);
impl R { fn u(&mut self)->f64{ self.0=self.0.wrapping_add(0x9E37_79B9_7F4A_7C15); let mut z=self.0; z=(z^(z>>30)).wrapping_mul(0xBF58_476D_1CE4_E5B9); z=(z^(z>>27)).wrapping_mul(0x94D0_49BB_1331_11EB); z^=z>>31; (z>>11) as f64/(1u64<<53) as f64}}

fn time<F: FnMut(usize)->f64>(name:&str, n:usize, mut f:F){
    let mut best=f64::INFINITY;
    let mut acc=0.0;
    for _ in 0..5 { let t=Instant::now(); for i in 0..n { acc+=f(i);} let e=t.elapsed().as_secs_f64()*1e9/n as f64; if e<best {best=e;} }
    black_box(acc);
    println!("{name}: {best:.1} ns");
}
fn numeric(name:&str, chain:&SerialChain<6>) {
    println!("{name}");
    let mut r=R(1);
    let n=20000;
    let lim=*chain.position_limits();
    let qs: Vec<[f64;6]> = (0..n).map(|_| lim.map(|(a,b)| a+(b-a)*r.u())).collect();
    let poses: Vec<Pose> = qs.iter().map(|q| chain.forward(q)).collect();
    let near: Vec<[f64;6]> = qs.iter().map(|q| q.map(|x| x+0.05*(2.0*r.u()-1.0))).collect();
    let far: Vec<[f64;6]> = (0..n).map(|_| lim.map(|(a,b)| a+(b-a)*r.u())).collect();
    time("chain fk",n,|i| black_box(chain.forward(black_box(&qs[i]))).translation.x);
    time("chain jac",n,|i| black_box(chain.axes(black_box(&qs[i])).jacobian())[0]);
    let st=SolverSettings{position_tolerance:1e-9,rotation_tolerance:1e-9,..SolverSettings::default()};
    time("near",n,|i| chain.solve(&poses[i],black_box(&near[i]),&st).map_or(0.0,|s|s.q[0]));
    let ok=(0..n).filter(|&i| chain.solve(&poses[i],&near[i],&st).is_ok()).count();
    let one=(0..n).filter(|&i| chain.solve(&poses[i],&near[i],&st).is_ok_and(|s|s.starts==1)).count();
    let its:usize=(0..n).map(|i| chain.solve(&poses[i],&near[i],&st).map_or(0,|s|s.iterations)).sum();
    println!("near ok {ok} first start {one} iterations {:.2}", its as f64/n as f64);
    let st=SolverSettings::default();
    let t=Instant::now();
    let mut its=0; let mut ok=0; let mut starts=0; let mut worst=0; let mut first=0; let mut res=0.0f64; let mut lim=0;
    let mut times=vec![];
    for i in 0..n { let t=Instant::now(); let r=chain.solve(&poses[i],&far[i],&st); times.push(t.elapsed().as_secs_f64()*1e6); match r { Ok(s)=>{ok+=1; its+=s.iterations; starts+=s.starts; worst=worst.max(s.iterations); if s.starts==1 {first+=1;} res=res.max(s.position_residual)}, Err(InverseError::PositionLimit{..})=>lim+=1, Err(_)=>{} } }
    let el=t.elapsed().as_secs_f64()*1e6/n as f64;
    times.sort_by(|a,b| a.total_cmp(b));
    println!("random: mean {el:.1} us p99 {:.1} max {:.1}, ok {:.3} %, limits {lim}, first start {:.1} %, starts {:.2}, iterations {:.1}, worst {worst}, {res:e}", times[n*99/100], times[n-1], ok as f64*100.0/n as f64, first as f64*100.0/n as f64, starts as f64/ok as f64, its as f64/ok as f64);
}
fn main(){
    let a=models::irb2400();
    numeric("irb2400", &SerialChain::from_axes(&a.axes(&[0.0;6]), *a.limits()).unwrap());
    let a=models::ar2010();
    numeric("ar2010", &SerialChain::from_axes(&a.axes(&[0.0;6]), *a.limits()).unwrap());
    numeric("ur5e", &models::ur5e());
    if std::env::args().len()>1 {return;}
    for arm in [models::ar2010(), models::irb2400()] {
    let mut r=R(1);
    let n=20000;
    let qs: Vec<[f64;6]> = (0..n).map(|_| arm.position_limits().map(|(a,b)| a+(b-a)*r.u())).collect();
    let poses: Vec<Pose> = qs.iter().map(|q| arm.forward(q)).collect();
    let jets: Vec<PoseJet> = poses.iter().map(|p| { let mut v=||Vector3::new(r.u(),r.u(),r.u()); PoseJet{pose:*p,linear:[v(),v(),v()],angular:[v(),v(),v()]}}).collect();
    time("fk",n,|i| black_box(arm.forward(black_box(&qs[i]))).translation.x);
    time("jacobian",n,|i| black_box(arm.axes(black_box(&qs[i])).jacobian())[0]);
    time("all",n,|i| black_box(arm.inverse(black_box(&poses[i]),&qs[i])).unwrap().as_slice().len() as f64);
    time("within",n,|i| black_box(arm.inverse_within_limits(black_box(&poses[i]),&qs[i])).unwrap().as_slice().len() as f64);
    time("nearest",n,|i| black_box(arm.inverse_nearest(black_box(&poses[i]),&qs[i])).unwrap()[0]);
    time("jet",n,|i| black_box(arm.joint_jet(black_box(&jets[i]),&qs[i])).unwrap().velocity[0]);
    }
}
