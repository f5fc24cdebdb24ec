"""Names as people write them on sites, in the languages of the field's users; not taken from Muster's own lists."""

CLOSED = """
No-fly: hospital; NO FLY ZONE 3; NoFlyZone; nfz-2; Keep out; Restricted area R-12; Danger area; Do not enter; No entry;
Off-limits; Prohibited: depot; Geofence exclusion; Hazard; Flugverbotszone Klinik; Sperrgebiet Nord; Gefahrenbereich;
Naturschutzgebiet; Betreten verboten; Zone interdite; Zone d'exclusion; Accès interdit; Zona prohibida; Zona peligrosa;
Área restringida; Zona vietata; Area proibita; Zona pericolosa; Zona proibida; Área interditada; Verboden gebied;
Gevarenzone; Strefa zakazu lotów; Obszar niebezpieczny; Zakázaná oblast; Nebezpečná zóna; Forbudt område; Farlig område;
Förbjudet område; Flyforbudssone; Uçuşa yasak bölge; Tehlikeli alan; Запретная зона; Опасная зона; Заборонена зона;
Небезпечна зона; Απαγορευμένη ζώνη; Επικίνδυνη περιοχή; منطقة محظورة; منطقة خطرة; منطقه ممنوعه; אזור אסור לטיסה;
אזור סכנה; निषिद्ध क्षेत्र; खतरनाक क्षेत्र; 禁飞区; 危险区域; 飛行禁止区域; 立入禁止; 비행금지구역; 위험 구역
"""
BOUNDARY = """
Operation area; AO; Perimeter; Site boundary; Einsatzgebiet; Grundstücksgrenze; Périmètre; Zone d'opération;
Área de operaciones; Perímetro; Area operativa; Confine; Área de operação; Operatiegebied; Grens; Obszar operacyjny;
Granica terenu; Operační oblast; Hranice; Operasjonsområde; Gräns; Grænse; Operasyon alanı; Sınır; Граница участка;
Район операции; Межа ділянки; Периметр; Όρια; Περίμετρος; منطقة العمليات; محدوده عملیات; אזור פעולה; गाँव की सीमा; 作业区域;
边界; 作業区域; 境界; 작전구역; 경계
"""
SURVEY = """
Search areas; Sector A (forest edge); Sweep 3; AOI; Area of interest; Suchgebiet Nord; Suchsektor 4; Secteur A;
Zone de recherche; Sector de búsqueda; Settore 2; Area di ricerca; Área de busca; Zoekgebied; Obszar poszukiwań;
Pátrací oblast; Søkeområde; Sökområde; Eftersøgningsområde; Arama bölgesi; Зона поиска; Сектор 5; Зона пошуку;
Περιοχή έρευνας; منطقة البحث; منطقه جستجو; אזור חיפוש; खोज क्षेत्र; 搜索区域; 捜索エリア; 수색 구역
"""
AIRCRAFT = """
drones; UAV fleet; sUAS; quadcopters; Multirotor team; VTOL 2; Mavic-3; DJI M300; Drohnen; Multikopter; Flugroboter;
aéronefs; drones du SDIS; cuadricópteros; aeronave; droni; quadricotteri; aeronaves; vliegtuigen; drony; dron 1;
kvadrokoptéry; droner; Drönare; dronlar; İHA filosu; дроны; БПЛА; квадрокоптеры; дрони; безпілотники; ντρόουν;
αεροσκάφη; طائرات بدون طيار; پهپادها; רחפנים; ड्रोन; 无人机; 無人機; ドローン; 드론
"""
GROUND = """
rovers; UGV 1; AGV-3; AMR fleet; trucks; Husky; Bodenroboter; Gabelstapler; camions; carretillas; rover lunare;
vrachtwagens; łaziki; наземные роботы; вантажівки; 卡车; トラック; 트럭
"""
PLACES = """
Bridge; Hut; Last phone position; mast 1; Turm; Église; Puente; Torre; Köprü; Мост; Γέφυρα; جسر; پل; גשר; पुल; 桥; 橋;
다리; Wind turbine 4; Valve 17
"""


def listed(names):
    """The names of one of the lists."""
    return [name.strip() for name in names.replace("\n", " ").split(";") if name.strip()]
