//! Three ranks that are threads, one of which may be gone.

use piola_ranks::Threads;

use super::*;

/// The particles of three ranks.
const BOUNDS: [usize; 4] = [0, 16, 32, 41];

/// What each of three ranks returns, of which `leaves` is gone before it takes part.
fn on_ranks<T: Send>(leaves: Option<usize>, body: impl Fn(&Team) -> T + Sync) -> Vec<Option<T>> {
    std::thread::scope(|scope| {
        let body = &body;
        let run = |rank: Threads| {
            scope.spawn(move || {
                if leaves == Some(rank.rank()) {
                    return None;
                }
                Some(body(&Team::new(Arc::new(rank), BOUNDS.to_vec(), Halo::default())))
            })
        };
        let all: Vec<_> = Threads::group(3).into_iter().map(run).collect();
        all.into_iter().map(|rank| rank.join().expect("it does not panic")).collect()
    })
}

/// Numbers of particles, and twice as many of those with an odd number.
fn place(a: usize) -> usize {
    a + a / 2
}

#[test]
fn all_ranks_have_what_each_has_filled() {
    let count = BOUNDS[3];
    let filled = |team: &Team| {
        let mut rows = vec![[0.0; 2]; count];
        team.fill(&mut rows, |first, rows| {
            rows.iter_mut().enumerate().for_each(|(k, row)| *row = [(first + k) as f64, 1.0]);
        });
        let mut spans = vec![-1.0; place(count)];
        let own = team.share_of(count);
        for (k, span) in spans[place(own.start)..place(own.end)].iter_mut().enumerate() {
            *span = (place(own.start) + k) as f64;
        }
        team.complete(&mut spans, place);
        team.fill(&mut [] as &mut [f64], |_, _| panic!("there is nothing"));
        (rows, spans, [0, 1, 2, 7, 100].map(|items| team.even_share(items)))
    };
    let alone = filled(&Team::default());
    assert_eq!(alone.2, [0..0, 0..1, 0..2, 0..7, 0..100]);
    let all: Vec<_> = on_ranks(None, filled).into_iter().flatten().collect();
    assert_eq!(all.len(), 3);
    for (rows, spans, _) in &all {
        assert_eq!(*rows, alone.0);
        assert!(spans.iter().enumerate().all(|(k, span)| *span == k as f64), "{spans:?}");
    }
    for (k, whole) in alone.2.into_iter().enumerate() {
        let items: Vec<usize> = all.iter().flat_map(|(.., shares)| shares[k].clone()).collect();
        assert_eq!(items, whole.collect::<Vec<_>>());
    }
}

#[test]
fn where_a_rank_is_lost_there_are_no_numbers_of_others() {
    let told = on_ranks(Some(1), |team| {
        let mut rows = vec![7.0_f64; BOUNDS[3]];
        team.fill(&mut rows, |_, rows| rows.fill(1.0));
        (rows, team.share_of(BOUNDS[3]), team.fault().is_some())
    });
    for (rows, own, is_lost) in told.into_iter().flatten() {
        assert!(is_lost);
        for (a, row) in rows.iter().enumerate() {
            assert!(if own.contains(&a) { *row == 1.0 } else { row.is_nan() }, "{a}: {row}");
        }
    }
}
