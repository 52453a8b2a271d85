//! Names of bright stars by their number in the Hipparcos catalogue.
//!
//! Source: IAU Catalog of Star Names, Working Group on Star Names of Division C. The numbers were compared
//! with position and magnitude in the catalogue.

/// A bright star with a name.
struct NamedStar {
    hip: u32,
    name: &'static str,
}

/// Stars by number.
const NAMED: &[NamedStar] = &[
    NamedStar { hip: 677, name: "Alpheratz" },
    NamedStar { hip: 746, name: "Caph" },
    NamedStar { hip: 3179, name: "Schedar" },
    NamedStar { hip: 3419, name: "Diphda" },
    NamedStar { hip: 5447, name: "Mirach" },
    NamedStar { hip: 7588, name: "Achernar" },
    NamedStar { hip: 9640, name: "Almach" },
    NamedStar { hip: 9884, name: "Hamal" },
    NamedStar { hip: 11767, name: "Polaris" },
    NamedStar { hip: 14135, name: "Menkar" },
    NamedStar { hip: 14576, name: "Algol" },
    NamedStar { hip: 15863, name: "Mirfak" },
    NamedStar { hip: 17702, name: "Alcyone" },
    NamedStar { hip: 21421, name: "Aldebaran" },
    NamedStar { hip: 23875, name: "Cursa" },
    NamedStar { hip: 24436, name: "Rigel" },
    NamedStar { hip: 24608, name: "Capella" },
    NamedStar { hip: 25336, name: "Bellatrix" },
    NamedStar { hip: 25428, name: "Elnath" },
    NamedStar { hip: 25930, name: "Mintaka" },
    NamedStar { hip: 25985, name: "Arneb" },
    NamedStar { hip: 26207, name: "Meissa" },
    NamedStar { hip: 26241, name: "Hatysa" },
    NamedStar { hip: 26311, name: "Alnilam" },
    NamedStar { hip: 26634, name: "Phact" },
    NamedStar { hip: 26727, name: "Alnitak" },
    NamedStar { hip: 27366, name: "Saiph" },
    NamedStar { hip: 27989, name: "Betelgeuse" },
    NamedStar { hip: 28360, name: "Menkalinan" },
    NamedStar { hip: 30324, name: "Mirzam" },
    NamedStar { hip: 30438, name: "Canopus" },
    NamedStar { hip: 31681, name: "Alhena" },
    NamedStar { hip: 32349, name: "Sirius" },
    NamedStar { hip: 33579, name: "Adhara" },
    NamedStar { hip: 34444, name: "Wezen" },
    NamedStar { hip: 35904, name: "Aludra" },
    NamedStar { hip: 36850, name: "Castor" },
    NamedStar { hip: 37279, name: "Procyon" },
    NamedStar { hip: 37826, name: "Pollux" },
    NamedStar { hip: 39429, name: "Naos" },
    NamedStar { hip: 41037, name: "Avior" },
    NamedStar { hip: 42913, name: "Alsephina" },
    NamedStar { hip: 44816, name: "Suhail" },
    NamedStar { hip: 45238, name: "Miaplacidus" },
    NamedStar { hip: 45556, name: "Aspidiske" },
    NamedStar { hip: 46390, name: "Alphard" },
    NamedStar { hip: 49669, name: "Regulus" },
    NamedStar { hip: 50583, name: "Algieba" },
    NamedStar { hip: 53910, name: "Merak" },
    NamedStar { hip: 54061, name: "Dubhe" },
    NamedStar { hip: 54872, name: "Zosma" },
    NamedStar { hip: 57632, name: "Denebola" },
    NamedStar { hip: 58001, name: "Phecda" },
    NamedStar { hip: 59774, name: "Megrez" },
    NamedStar { hip: 59803, name: "Gienah" },
    NamedStar { hip: 60718, name: "Acrux" },
    NamedStar { hip: 61084, name: "Gacrux" },
    NamedStar { hip: 62434, name: "Mimosa" },
    NamedStar { hip: 62956, name: "Alioth" },
    NamedStar { hip: 63125, name: "Cor Caroli" },
    NamedStar { hip: 63608, name: "Vindemiatrix" },
    NamedStar { hip: 65378, name: "Mizar" },
    NamedStar { hip: 65474, name: "Spica" },
    NamedStar { hip: 67301, name: "Alkaid" },
    NamedStar { hip: 68702, name: "Hadar" },
    NamedStar { hip: 68933, name: "Menkent" },
    NamedStar { hip: 69673, name: "Arcturus" },
    NamedStar { hip: 71681, name: "Toliman" },
    NamedStar { hip: 71683, name: "Rigil Kentaurus" },
    NamedStar { hip: 72105, name: "Izar" },
    NamedStar { hip: 72607, name: "Kochab" },
    NamedStar { hip: 76267, name: "Alphecca" },
    NamedStar { hip: 77070, name: "Unukalhai" },
    NamedStar { hip: 78401, name: "Dschubba" },
    NamedStar { hip: 80763, name: "Antares" },
    NamedStar { hip: 82273, name: "Atria" },
    NamedStar { hip: 84012, name: "Sabik" },
    NamedStar { hip: 85670, name: "Rastaban" },
    NamedStar { hip: 85927, name: "Shaula" },
    NamedStar { hip: 86032, name: "Rasalhague" },
    NamedStar { hip: 86228, name: "Sargas" },
    NamedStar { hip: 87833, name: "Eltanin" },
    NamedStar { hip: 90185, name: "Kaus Australis" },
    NamedStar { hip: 91262, name: "Vega" },
    NamedStar { hip: 92855, name: "Nunki" },
    NamedStar { hip: 95947, name: "Albireo" },
    NamedStar { hip: 97278, name: "Tarazed" },
    NamedStar { hip: 97649, name: "Altair" },
    NamedStar { hip: 100453, name: "Sadr" },
    NamedStar { hip: 100751, name: "Peacock" },
    NamedStar { hip: 102098, name: "Deneb" },
    NamedStar { hip: 102488, name: "Aljanah" },
    NamedStar { hip: 105199, name: "Alderamin" },
    NamedStar { hip: 107315, name: "Enif" },
    NamedStar { hip: 109268, name: "Alnair" },
    NamedStar { hip: 113368, name: "Fomalhaut" },
    NamedStar { hip: 113881, name: "Scheat" },
    NamedStar { hip: 113963, name: "Markab" },
];

/// Returns the name of a star of the Hipparcos catalogue; `None` if the table has none.
pub fn star_name(hip: u32) -> Option<&'static str> {
    let place = NAMED.binary_search_by_key(&hip, |star| star.hip).ok()?;
    NAMED.get(place).map(|star| star.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::catalog::Catalog;

    #[test]
    fn names_are_in_the_order_of_numbers_and_belong_to_bright_stars() {
        assert!(NAMED.is_sorted_by_key(|star| star.hip));
        let catalog = Catalog::hipparcos2();
        for NamedStar { hip, name } in NAMED {
            let star = catalog.stars().iter().find(|star| star.id == *hip);
            assert!(star.is_some_and(|star| star.v_mag() < 3.5), "{name}");
        }
    }

    /// The stars brighter than V = 1.0, apart from the second star of α Centauri, have names.
    #[test]
    fn the_brightest_stars_have_names() {
        let catalog = Catalog::hipparcos2();
        let bright = catalog.stars().iter().filter(|star| star.v_mag() < 1.0);
        let names: Vec<_> = bright.map(|star| star_name(star.id).unwrap_or("?")).collect();
        assert!(names.len() > 12 && !names.contains(&"?"), "{names:?}");
        assert_eq!(
            (star_name(24436), star_name(27989), star_name(1)),
            (Some("Rigel"), Some("Betelgeuse"), None)
        );
    }
}
