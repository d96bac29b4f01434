//! Arbitrary and damaged bytes end in functions or an error, never in a panic or a huge allocation.

use jointscope_import::{ColumnMap, read};
use proptest::prelude::*;

const SAMPLES: [&[u8]; 6] = [
    include_bytes!("samples/testlab-v5.mat"),
    include_bytes!("samples/testlab-v7.mat"),
    include_bytes!("samples/testlab-v73.mat"),
    include_bytes!("samples/plain-v5.mat"),
    include_bytes!("samples/named-v73.mat"),
    b"# remark\nfrequency [Hz];4/1 real [m/s^2/N];4/1 imag;3/1 mag;3/1 phase [deg]\n10;0,5;1,5;3;90\n12,5;-1;2;4;180\n",
];

fn swallow(bytes: &[u8]) {
    for columns in [&[][..], &["4/1"], &["H(1)=4/1", "FRF(1)=3/1"]] {
        let _ = read(bytes, "test", &ColumnMap::parse(columns).unwrap());
    }
}

#[test]
fn every_truncation_is_survived() {
    for sample in SAMPLES {
        let step = (sample.len() / 500).max(1);
        (0..sample.len()).step_by(step).for_each(|length| swallow(&sample[..length]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn arbitrary_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        swallow(&bytes);
        swallow(&[SAMPLES[3].get(..128).unwrap(), &bytes].concat());
        swallow(&[b"\x89HDF\r\n\x1a\n".as_slice(), &bytes].concat());
    }

    #[test]
    fn arbitrary_tables_are_survived(text in "[-+0-9.,;eE/:a-z\t\n \\[\\]()\"#]{0,200}") {
        swallow(text.as_bytes());
        swallow(format!("f,4/1 real,4/1 imag\n1,2,3\n{text}").as_bytes());
        swallow(format!("{text}\n1,2,3\n").as_bytes());
    }

    #[test]
    fn flipped_inserted_and_deleted_bytes_are_survived(
        sample in 0..SAMPLES.len(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..3), 1..8),
    ) {
        let mut bytes = SAMPLES[sample].to_vec();
        for (at, byte, kind) in damage {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => { bytes.remove(at); }
            }
        }
        swallow(&bytes);
    }
}
